#include "eds_parser/budget/response_time.hpp"

#include <algorithm>

namespace takt {
namespace {

constexpr Time longest_busy_period = std::chrono::seconds{10};  // no bound beyond this
constexpr Time::rep recovery_bits = 31;  // bits from an error until the bus is free

Time::rep ceil_div(Time time, Time by) noexcept {
  return time <= Time{0} ? 0 : (time.count() + by.count() - 1) / by.count();
}

/// Returns the bus time of all frames of a stream that may be queued within `time`.
Time queued_within(Time time, const FrameStream& stream) noexcept {
  return ceil_div(time + stream.jitter, stream.period) * stream.burst * stream.frame;
}

/// The analysis of one stream.
class Analysis {
 public:
  Analysis(std::span<const FrameStream> streams, const FrameStream& own, Time bit,
           const WireErrors& errors) noexcept
      : own_{own}, bit_{bit}, errors_{errors} {
    longest_ = own.frame;
    for (const auto& other : streams) {
      if (!other.counts || &other == &own) continue;
      if (other.priority <= own.priority) {
        higher_.push_back(&other);
        longest_ = std::max(longest_, other.frame);
      } else if (other.priority > own.priority) {
        blocking_ = std::max(blocking_, other.frame);
      }
    }
  }

  std::optional<Time> run() const {
    if (utilisation() >= 1.0) return std::nullopt;
    const auto busy = busy_period();
    if (!busy) return std::nullopt;
    const auto instances = ceil_div(*busy + own_.jitter, own_.period);
    Time worst{0};
    for (Time::rep q = 0; q < instances; ++q) {
      const auto queued = queueing(q);
      if (!queued) return std::nullopt;
      worst = std::max(worst, own_.jitter + *queued - q * own_.period + own_.frame);
    }
    return worst;
  }

 private:
  double utilisation() const noexcept {
    const auto share = [](const FrameStream& stream) {
      return static_cast<double>(stream.burst * stream.frame.count()) /
             static_cast<double>(stream.period.count());
    };
    double sum = share(own_);
    for (const auto* other : higher_) sum += share(*other);
    if (errors_.burst != 0 && errors_.interval > Time{0}) {
      sum +=
          static_cast<double>(error_cost().count()) / static_cast<double>(errors_.interval.count());
    }
    return sum;
  }

  Time error_cost() const noexcept { return recovery_bits * bit_ + longest_; }

  Time errors_within(Time time) const noexcept { return error_time(time, errors_, bit_, longest_); }

  /// The longest time for which the bus may be busy with frames of this priority and of higher
  /// priorities.
  std::optional<Time> busy_period() const noexcept {
    Time time = own_.frame;
    for (;;) {
      Time next = errors_within(time) + blocking_ + queued_within(time, own_);
      for (const auto* other : higher_) next += queued_within(time, *other);
      if (next <= time) return time;
      if (next > longest_busy_period) return std::nullopt;
      time = next;
    }
  }

  /// Returns how long the last frame of instance q waits for the bus.
  std::optional<Time> queueing(Time::rep q) const noexcept {
    const Time before = ((q + 1) * own_.burst - 1) * own_.frame;
    Time wait = blocking_ + before;
    for (;;) {
      Time next = errors_within(wait + own_.frame) + blocking_ + before;
      for (const auto* other : higher_) next += queued_within(wait + bit_, *other);
      if (next <= wait) return wait;
      if (next > longest_busy_period) return std::nullopt;
      wait = next;
    }
  }

  const FrameStream& own_;
  Time bit_;
  WireErrors errors_;
  std::vector<const FrameStream*> higher_;
  Time blocking_{};
  Time longest_{};
};

}  // namespace

Time error_time(Time time, const WireErrors& errors, Time bit, Time frame) noexcept {
  if (errors.burst == 0 || time <= Time{0}) return Time{0};
  const auto more = errors.interval > Time{0} ? ceil_div(time, errors.interval) - 1 : 0;
  return (static_cast<Time::rep>(errors.burst) + more) * (recovery_bits * bit + frame);
}

std::vector<std::optional<Time>> worst_responses(std::span<const FrameStream> streams, Time bit,
                                                 const WireErrors& errors) {
  std::vector<std::optional<Time>> worst;
  worst.reserve(streams.size());
  for (const auto& stream : streams) {
    worst.push_back(Analysis{streams, stream, bit, errors}.run());
  }
  return worst;
}

}  // namespace takt
