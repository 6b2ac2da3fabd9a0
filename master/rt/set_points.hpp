#pragma once
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "eds_parser/table/time.hpp"
#include "master/core/set_point.hpp"

namespace takt {

/// One set of commands for all outputs, as a whole.
struct SetPointFrame {
  std::vector<SetPoint> points;  ///< in the order of the layout's outputs
  Time when{};                   ///< of publish()
};

/// Commands on their way from the front thread to the bus thread: a triple buffer, the newest set
/// wins and is never torn. Wait-free on both sides.
class SetPoints {
 public:
  explicit SetPoints(std::size_t outputs);

  /// Front thread: stages a command; nothing is seen before publish(). `output` counts from 0
  /// within the outputs. `time_to_live` in cycles, 0: as configured.
  void set(std::size_t output, std::int64_t value, std::uint32_t time_to_live = 0) noexcept;
  /// Front thread: hands over all that is staged.
  void publish(Time now) noexcept;

  /// Bus thread: the newest set; valid until the next call.
  const SetPointFrame& newest() noexcept;

 private:
  static constexpr unsigned fresh = 4;  ///< flag beside the index: not yet read

  std::array<SetPointFrame, 3> frames_;
  std::vector<SetPoint> staged_;       // front thread's
  std::vector<std::uint32_t> handed_;  // front thread's: generations at the last publish()
  unsigned back_ = 0;                  // front thread's
  alignas(64) std::atomic<unsigned> middle_{1};
  alignas(64) unsigned front_ = 2;  // bus thread's
};

}  // namespace takt
