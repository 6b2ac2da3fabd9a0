#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "apps/takt/smooth/judge/bus_record.hpp"

namespace takt::smooth {

/// The value of a signal at increasing times: that of its newest sample.
class Held {
 public:
  explicit Held(const std::vector<Sample>& samples) : samples_{samples} {}

  /// Returns std::nullopt before the first sample.
  std::optional<std::int64_t> at(Time when) {
    while (next_ < samples_.size() && samples_[next_].when <= when) ++next_;
    return next_ == 0 ? std::nullopt : std::optional{samples_[next_ - 1].value};
  }

 private:
  const std::vector<Sample>& samples_;
  std::size_t next_ = 0;
};

/// Returns true if the statusword (6041) shows Operation enabled. CiA 402-2.
constexpr bool is_operation_enabled(std::int64_t statusword) noexcept {
  return (statusword & 0x6F) == 0x27;
}

/// Returns true if a drive in this mode (6061) takes a set-point in each cycle: csp and ip, or csv
/// for set-points of velocity.
constexpr bool is_cyclic_mode(std::int64_t mode, bool by_velocity) noexcept {
  return by_velocity ? mode == 9 : mode == 8 || mode == 7;
}

}  // namespace takt::smooth
