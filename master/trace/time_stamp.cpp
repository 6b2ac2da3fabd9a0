#include "master/trace/time_stamp.hpp"

#include <algorithm>
#include <chrono>

#include "eds_parser/values/number_in.hpp"

namespace takt {
namespace {

/// Converts a time stamp like `1436509052.249713` to microseconds.
std::optional<std::int64_t> seconds_in_us(std::string_view stamp) {
  const std::size_t dot = std::min(stamp.find('.'), stamp.size());
  const auto seconds = number_in<std::int64_t>(stamp.substr(0, dot), 10);
  if (!seconds || *seconds < 0 || *seconds > 100'000'000'000) return {};
  std::int64_t micros = 0;
  std::int64_t unit = 100'000;
  for (const char digit : stamp.substr(std::min(dot + 1, stamp.size()))) {
    if (digit < '0' || digit > '9') return {};
    micros += (digit - '0') * unit;
    unit /= 10;
  }
  return *seconds * 1'000'000 + micros;
}

}  // namespace

std::optional<std::int64_t> stamp_in_us(std::string_view stamp) {
  if (stamp.size() < 19 || stamp[10] != ' ') return seconds_in_us(stamp);
  const auto part = [&](std::size_t at, std::size_t size) {
    return number_in<unsigned>(stamp.substr(at, size), 10);
  };
  const auto year = part(0, 4);
  const auto month = part(5, 2);
  const auto day = part(8, 2);
  const auto hours = part(11, 2);
  const auto minutes = part(14, 2);
  const auto seconds = seconds_in_us(stamp.substr(17));
  if (!year || !month || !day || !hours || !minutes || !seconds) return {};
  const std::chrono::year_month_day date{std::chrono::year{static_cast<int>(*year)},
                                         std::chrono::month{*month}, std::chrono::day{*day}};
  if (!date.ok()) return {};
  const std::int64_t days = std::chrono::sys_days{date}.time_since_epoch().count();
  return ((days * 24 + *hours) * 60 + *minutes) * 60'000'000 + *seconds;
}

}  // namespace takt
