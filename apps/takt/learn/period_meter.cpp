#include "apps/takt/learn/period_meter.hpp"

#include <algorithm>
#include <cstdlib>
#include <vector>

namespace takt::learn {

void PeriodMeter::add(std::optional<std::int64_t> us) noexcept {
  ++count_;
  if (us && last_ && *us >= *last_) {
    intervals_[next_] = *us - *last_;
    next_ = (next_ + 1) % static_cast<std::uint32_t>(intervals_.size());
    used_ = std::min(used_ + 1, static_cast<std::uint32_t>(intervals_.size()));
  }
  last_ = us;
}

std::optional<std::int64_t> PeriodMeter::median() const {
  if (used_ < 3) return {};
  std::vector<std::int64_t> sorted(intervals_.begin(), intervals_.begin() + used_);
  const auto middle = sorted.begin() + used_ / 2;
  std::ranges::nth_element(sorted, middle);
  return *middle;
}

std::optional<std::int64_t> PeriodMeter::shortest() const {
  if (used_ == 0) return {};
  return *std::min_element(intervals_.begin(), intervals_.begin() + used_);
}

std::optional<std::int64_t> PeriodMeter::steady() const {
  const auto usual = median();
  if (!usual) return {};
  const auto near = [&](std::int64_t us) { return std::abs(us - *usual) * 50 <= *usual; };
  const auto hits = std::count_if(intervals_.begin(), intervals_.begin() + used_, near);
  return hits * 4 >= std::int64_t{used_} * 3 ? usual : std::nullopt;
}

std::int64_t as_configured(std::int64_t measured) noexcept {
  for (std::int64_t unit = 1; unit <= 1'000'000'000; unit *= 10) {
    for (const std::int64_t tenths : {10, 20, 25, 40, 50, 80}) {
      const std::int64_t usual = unit * tenths / 10;
      if (usual >= 100 && std::abs(usual - measured) * 100 <= measured) return usual;
    }
  }
  for (std::int64_t step = 1'000'000'000; step > 1; step /= 10) {
    for (const std::int64_t part : {step, step / 2, step / 4}) {
      if (part == 0) continue;
      const std::int64_t round = (measured + part / 2) / part * part;
      if (round != 0 && std::abs(round - measured) * 400 <= measured) return round;
    }
  }
  return measured;
}

std::optional<std::int64_t> as_configured_ms(std::optional<std::int64_t> measured_us) noexcept {
  if (!measured_us) return {};
  const std::int64_t ms = as_configured(*measured_us) / 1000;
  return ms >= 1 && ms <= 65535 ? std::optional{ms} : std::nullopt;
}

}  // namespace takt::learn
