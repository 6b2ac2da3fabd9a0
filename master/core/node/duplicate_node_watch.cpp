#include "master/core/node/duplicate_node_watch.hpp"

#include <algorithm>

#include "master/wire/sdo_codec.hpp"

namespace takt {
namespace {

constexpr std::uint32_t window_periods = 8;
constexpr std::uint32_t most_heartbeats = 12;  // a change of state may add a heartbeat
constexpr std::uint32_t most_surplus = 2;      // surplus answers

enum class SeenRequest : std::uint8_t { other, transfer, block };

/// Classifies the frame of a client. CiA 301, 7.2.4.3: the beginning of every transfer has exactly
/// one answer.
SeenRequest request_of(const Frame& frame) noexcept {
  switch (frame.data[0] >> 5U) {
    case 1:
    case 2:
      return SeenRequest::transfer;
    case 5:
    case 6:
      return SeenRequest::block;
    default:
      return SeenRequest::other;
  }
}

bool answers_transfer(const Frame& frame) noexcept {
  const unsigned command = frame.data[0] >> 5U;
  return frame.length >= 4 && (command == 2 || command == 3);
}

}  // namespace

void DuplicateNodeWatch::restart() noexcept {
  heartbeats_ = full_windows_ = asked_ = answered_ = 0;
  window_begin_ = Time{};
}

std::optional<DuplicateSign> DuplicateNodeWatch::once(DuplicateSign sign, Time now) noexcept {
  restart();
  if (now - reported_ < report_again) return std::nullopt;
  reported_ = now;
  return sign;
}

std::optional<DuplicateSign> DuplicateNodeWatch::on_heartbeat(Time now) noexcept {
  if (period_ <= Time{}) return std::nullopt;
  if (now - window_begin_ >= window_periods * period_) {
    full_windows_ = heartbeats_ > most_heartbeats ? full_windows_ + 1 : 0;
    window_begin_ = now;
    heartbeats_ = 0;
  }
  ++heartbeats_;
  return full_windows_ < 2 ? std::nullopt : once(DuplicateSign::heartbeats, now);
}

void DuplicateNodeWatch::on_sdo_requests(std::span<const Frame> frames) noexcept {
  for (const Frame& frame : frames) {
    const SeenRequest request = frame.id == sdo_request_ ? request_of(frame) : SeenRequest::other;
    if (request == SeenRequest::other) continue;
    objects_ = {sdo_object(frame), objects_[0]};
    block_ = request == SeenRequest::block;
    asked_ += !block_;
  }
}

std::optional<DuplicateSign> DuplicateNodeWatch::on_sdo_answer(const Frame& frame,
                                                               Time now) noexcept {
  const bool asked_for = std::ranges::find(objects_, sdo_object(frame)) != objects_.end();
  if (block_ || !answers_transfer(frame) || !asked_for) return std::nullopt;
  ++answered_;
  return answered_ <= asked_ + most_surplus ? std::nullopt : once(DuplicateSign::answers, now);
}

}  // namespace takt
