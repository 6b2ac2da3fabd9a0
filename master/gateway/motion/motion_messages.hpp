#pragma once
#include <cstdint>
#include <takt/motion_t.hpp>
#include <vector>

#include "eds_parser/table/motion_axes.hpp"
#include "master/rt/exchange/motion_board.hpp"

namespace takt {

/// What the gateway knows of the motions of one axis, in the numbers of the application.
struct ShownMotion {
  /// How a motion has ended; the numbers of axis_motion_t::outcome.
  enum class Ended : std::uint8_t { none, done, stopped, replaced, refused };

  std::int32_t id = 0;        ///< of the motion that runs
  std::int32_t ended_id = 0;  ///< of the one that ended last
  Ended ended = Ended::none;
};

/// The messages about the motions of one cycle. The caller sets `utime` and `session`.
std::vector<motion_t> motion_messages(const BusPlan& plan, const std::vector<MotionAxis>& axes,
                                      const MotionSnapshot& snapshot,
                                      const std::vector<ShownMotion>& shown);

}  // namespace takt
