#include "apps/takt/smooth/trace.hpp"

#include <numeric>
#include <utility>

#include "master/trace/time_stamp.hpp"

namespace takt::smooth {
namespace {

using std::chrono::microseconds;

constexpr std::size_t most_line = 512;

/// Returns the resolution of time stamps by the greatest common divisor of all of them.
Time resolution_of(std::int64_t divisor_us) {
  for (const std::int64_t us : {10'000, 1'000, 100, 10}) {
    if (divisor_us % us == 0) return microseconds{us};
  }
  return microseconds{1};
}

}  // namespace

TraceBuilder::TraceBuilder(std::string name, const std::string& interface)
    : interface_{interface}, recording_{std::move(name), interface} {}

void TraceBuilder::add(const std::string& text) {
  recording_.add(text, ++line_);
  const auto line = lines_.parse(text);
  if (!line || line->error_frame) return;
  if (interface_.empty()) interface_ = line->interface;
  if (line->interface == interface_) keep(line->frame, line->stamp);
}

void TraceBuilder::keep(const Frame& frame, const std::string& stamp) {
  if (trace_.frames.size() == most_frames) {
    trace_.cut = true;
    return;
  }
  const auto us = stamp_in_us(stamp);
  if (!us) trace_.with_times = false;
  if (trace_.frames.empty()) first_us_ = us.value_or(0);
  const std::int64_t since = us.value_or(0) - first_us_;
  divisor_us_ = std::gcd(divisor_us_, since);
  Time when = microseconds{since};
  if (!trace_.frames.empty()) when = std::max(when, trace_.frames.back().when + Time{1});
  trace_.frames.push_back({frame, when});
}

Trace TraceBuilder::take() {
  trace_.bus = recording_.take();
  trace_.resolution = resolution_of(divisor_us_);
  return std::move(trace_);
}

Trace read_trace(std::istream& in, const std::string& name, const std::string& interface) {
  TraceBuilder builder{name, interface};
  std::string text;
  for (int c = in.get(); c != std::char_traits<char>::eof(); c = in.get()) {
    if (c != '\n') {
      if (text.size() < most_line) text.push_back(static_cast<char>(c));
      continue;
    }
    builder.add(text);
    text.clear();
  }
  if (!text.empty()) builder.add(text);
  return builder.take();
}

}  // namespace takt::smooth
