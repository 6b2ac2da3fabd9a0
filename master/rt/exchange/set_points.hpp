#pragma once
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "eds_parser/values/time.hpp"
#include "master/core/set_point.hpp"

namespace takt {

/// One set of commands for all outputs.
struct SetPointFrame {
  std::vector<SetPoint> points;  ///< in the order of the layout's outputs
  Time when{};                   ///< time of publish()
};

/// Carries commands from the front thread to the bus thread in a triple buffer. The newest set wins
/// and is never torn. Wait-free on both sides.
class SetPoints {
 public:
  explicit SetPoints(std::size_t outputs);

  /// Front thread: stages a command, which stays invisible until publish(). `output` counts from 0
  /// within the outputs. `time_to_live` counts cycles; 0 selects the configured value.
  void set(std::size_t output, std::int64_t value, std::uint32_t time_to_live = 0) noexcept;
  /// Front thread: hands over all staged commands.
  void publish(Time now) noexcept;

  /// Bus thread: returns the newest set, valid until the next call.
  const SetPointFrame& newest() noexcept;

 private:
  static constexpr unsigned fresh = 4;  ///< flag next to the index: the set has not been read yet

  std::array<SetPointFrame, 3> frames_;
  std::vector<SetPoint> staged_;       // front thread only
  std::vector<std::uint32_t> handed_;  // front thread only: generations at the last publish()
  unsigned back_ = 0;                  // front thread only
  alignas(64) std::atomic<unsigned> middle_{1};
  alignas(64) unsigned front_ = 2;  // bus thread only
};

}  // namespace takt
