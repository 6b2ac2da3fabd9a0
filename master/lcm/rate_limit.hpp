#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "eds_parser/values/time.hpp"

namespace takt {

/// Permits the same text once and then at most once per `pause`, and counts how often it was
/// withheld. Remembers a bounded number of texts.
class RateLimit {
 public:
  explicit RateLimit(Time pause, std::size_t capacity = 64) : pause_{pause}, capacity_{capacity} {}

  /// Returns std::nullopt if the text must be withheld. Otherwise returns how often it was withheld
  /// since the last time.
  std::optional<std::uint64_t> allow(const std::string& thing, Time now);

 private:
  struct Entry {
    std::string thing;
    Time reported{};
    std::uint64_t kept_back = 0;
  };
  Time pause_;
  std::size_t capacity_;
  std::vector<Entry> entries_;
};

/// Adds to a sentence how many earlier ones were withheld, if any.
std::string with_kept_back(std::string sentence, std::uint64_t kept_back);

}  // namespace takt
