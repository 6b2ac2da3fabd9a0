#include "master/sim/pdo/rpdo.hpp"

#include <span>

#include "master/wire/bytes.hpp"

namespace takt::sim {
namespace {

constexpr std::uint16_t too_long = 0x8220;
constexpr std::uint16_t overdue = 0x8250;

}  // namespace

void Rpdo::start() noexcept {
  running_ = true;
  reconfigure();
}

void Rpdo::reconfigure() noexcept {
  record_.compile(mapping_);
  synchronous_ = record_.synchronous();
  full_ = false;
  deadline_ = never;
}

bool Rpdo::keep_until_sync(const Frame& frame, Time now, Time window_end,
                           const EmcyProducer& emcy) noexcept {
  const bool fits = frame.length == mapping_.bytes() && frame.length != 0 && now <= window_end;
  const bool watched = deadline_ != never || record_.event_timer() != Time{};
  if (!fits || watched || !synchronous_ || !emcy.quiet()) return false;
  if (!running_ || !record_.valid()) return false;
  data_ = load_le<std::uint64_t>(std::span{frame.data});
  full_ = true;
  return true;
}

bool Rpdo::on_frame(const Frame& frame, Time now, Time window_end, EmcyProducer& emcy) noexcept {
  if (!running_ || !record_.valid()) return false;
  if (!length_is_good(frame, emcy)) return false;
  if (synchronous_ && now > window_end) return false;
  data_ = load_le<std::uint64_t>(std::span{frame.data});
  full_ = true;
  emcy.clear(overdue, static_cast<std::uint8_t>(record_.number()));
  const Time limit = record_.event_timer();
  deadline_ = limit == Time{} ? never : now + limit;
  return !synchronous_;
}

/// The device discards a frame that is too short, and uses the first bytes of a frame that is too
/// long. CiA 301, 7.2.2.5.
bool Rpdo::length_is_good(const Frame& frame, EmcyProducer& emcy) noexcept {
  const auto number = static_cast<std::uint8_t>(record_.number());
  if (frame.length < mapping_.bytes()) {
    emcy.raise(too_short, ErrorBit::communication, {number});
    return false;
  }
  emcy.clear(too_short, number);
  if (frame.length > mapping_.bytes()) {
    emcy.raise(too_long, ErrorBit::communication, {number});
  } else {
    emcy.clear(too_long, number);
  }
  return true;
}

void Rpdo::apply() noexcept {
  if (full_) mapping_.unpack(data_);
  full_ = false;
}

void Rpdo::on_time(Time now, EmcyProducer& emcy) noexcept {
  if (now < deadline_) return;
  deadline_ = never;
  emcy.raise(overdue, ErrorBit::communication, {static_cast<std::uint8_t>(record_.number())});
}

}  // namespace takt::sim
