#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <takt/motion_t.hpp>
#include <vector>

#include "apps/plot/plot.hpp"

namespace takt {

/// An axis of a picture.
struct TracedAxis {
  std::int16_t node_id = 0;
  std::int8_t axis = 1;  ///< axis of the device, 1 to 8
  std::string name = {};
  bool has_velocity = false;  ///< its actual velocity (0x606C) is in a TPDO
  std::string unit = {};      ///< unit of its positions; empty: raw counts
};

/// Keeps the reports of taktd about the motions of all axes in each cycle. The memory is bounded:
/// when it is full, every second cycle is dropped, and from then on only every second new cycle is
/// kept.
class MotionTrace {
 public:
  static constexpr std::size_t most_cycles = 8192;

  /// Takes one message. The reports of one cycle may come in several messages.
  void take(const motion_t& message);
  /// Returns the picture of these axes, or a picture without panels if taktd has reported nothing
  /// about them. `period` is that of SYNC, in seconds.
  Plot plot(std::string title, std::span<const TracedAxis> axes, double period) const;

 private:
  struct Report {
    std::int16_t node_id;
    std::int8_t axis;
    double position;
    double velocity;
    double acceleration;
    double actual_position;
    double actual_velocity;
    double following_error;
  };
  struct Cycle {
    std::int64_t number;
    std::vector<Report> reports;
  };

  const Report* find(const Cycle& cycle, const TracedAxis& axis) const;
  void thin_out();

  std::vector<Cycle> cycles_;
  std::int64_t session_ = 0;
  std::int64_t every_ = 1;  // one of this number of cycles is kept
};

}  // namespace takt
