#pragma once
#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "eds_parser/table/output_limits.hpp"

namespace takt {

/// The limits and quick stop option codes that a boot has read from its device. It allocates only
/// in its constructor.
class LimitReadings {
 public:
  /// `most` is the number of steps `read_limit` in the boot plan.
  explicit LimitReadings(std::size_t most) : readings_(most) {}

  void clear() noexcept { count_ = 0; }
  /// Adds a reading. If the node restarts during its boot, the limit is read again and replaces the
  /// earlier reading.
  void take(const LimitReading& reading) noexcept {
    const auto place = std::ranges::find(all(), reading.object, &LimitReading::object);
    const auto index = static_cast<std::size_t>(place - all().begin());
    if (index == readings_.size()) return;
    readings_[index] = reading;
    count_ = std::max(count_, index + 1);
  }
  std::span<const LimitReading> all() const noexcept { return std::span{readings_}.first(count_); }

 private:
  std::vector<LimitReading> readings_;
  std::size_t count_ = 0;  // number of valid readings
};

}  // namespace takt
