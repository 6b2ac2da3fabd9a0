#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "eds_parser/values/time.hpp"

namespace takt::soak {

/// An invariant that a run has broken, and when.
struct Violation {
  std::uint64_t cycle = 0;
  Time when{};
  std::string invariant;  ///< name of the invariant, for example "no torn image"
  std::string what;
};

/// Keeps the first violation of a run; later ones are often only consequences of it.
class Verdict {
 public:
  void at(std::uint64_t cycle, Time now) noexcept {
    cycle_ = cycle;
    now_ = now;
  }
  void report_violation(std::string invariant, std::string what) {
    if (violation_) return;
    violation_ = {
        .cycle = cycle_, .when = now_, .invariant = std::move(invariant), .what = std::move(what)};
  }
  bool good() const noexcept { return !violation_; }
  const std::optional<Violation>& violation() const noexcept { return violation_; }

 private:
  std::uint64_t cycle_ = 0;
  Time now_{};
  std::optional<Violation> violation_;
};

}  // namespace takt::soak
