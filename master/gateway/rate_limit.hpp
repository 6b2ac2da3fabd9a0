#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "eds_parser/table/time.hpp"

namespace takt {

/// Lets the same thing be told once at first and then at most once a `pause`, with the number of
/// times it was kept back. Remembers a bounded number of things.
class RateLimit {
 public:
  explicit RateLimit(Time pause, std::size_t capacity = 64) : pause_{pause}, capacity_{capacity} {}

  /// Nothing: not now. Else: tell it; the value is how often it was kept back since the last time.
  std::optional<std::uint64_t> allow(const std::string& thing, Time now);

 private:
  struct Entry {
    std::string thing;
    Time told{};
    std::uint64_t kept_back = 0;
  };
  Time pause_;
  std::size_t capacity_;
  std::vector<Entry> entries_;
};

}  // namespace takt
