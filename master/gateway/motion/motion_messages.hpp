#pragma once
#include <cstdint>
#include <takt/motion_t.hpp>
#include <vector>

#include "eds_parser/table/motion_axes.hpp"
#include "master/rt/exchange/motion_board.hpp"

namespace takt {

/// What motion_t reports about the motions of one axis, with the ids of the application.
struct ShownMotion {
  /// The end of a motion. The numbers are those of axis_motion_t::outcome.
  enum class Ended : std::uint8_t { none, done, stopped, replaced, refused };

  std::int32_t id = 0;        ///< id of the motion that runs; 0 means none
  std::int32_t ended_id = 0;  ///< id of the motion that has ended last
  Ended ended = Ended::none;
};

/// Makes the messages about the motions of one cycle. The caller sets `utime` and `session`.
std::vector<motion_t> motion_messages(const BusPlan& plan, const std::vector<MotionAxis>& axes,
                                      const MotionSnapshot& snapshot,
                                      const std::vector<ShownMotion>& shown);

}  // namespace takt
