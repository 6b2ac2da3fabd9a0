#include "master/lcm/rate_limit.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <utility>

namespace takt {

std::optional<std::uint64_t> RateLimit::allow(const std::string& thing, Time now) {
  const auto found = std::ranges::find(entries_, thing, &Entry::thing);
  if (found != entries_.end()) {
    if (now - found->reported < pause_) {
      ++found->kept_back;
      return std::nullopt;
    }
    found->reported = now;
    return std::exchange(found->kept_back, 0);
  }
  if (entries_.size() == capacity_) {
    const auto oldest = std::ranges::min_element(entries_, {}, &Entry::reported);
    if (now - oldest->reported < pause_) return std::nullopt;  // a flood of different texts
    entries_.erase(oldest);
  }
  entries_.push_back({.thing = thing, .reported = now, .kept_back = 0});
  return 0;
}

std::string with_kept_back(std::string sentence, std::uint64_t kept_back) {
  if (kept_back == 0) return sentence;
  return fmt::format("{} ({} earlier ones were not reported)", sentence, kept_back);
}

}  // namespace takt
