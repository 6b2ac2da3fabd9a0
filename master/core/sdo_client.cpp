#include "master/core/sdo_client.hpp"

#include <cassert>
#include <utility>

#include "master/wire/sdo_abort.hpp"

namespace takt {

void SdoClient::upload(ObjectKey object, std::span<std::byte> buffer, Time timeout) noexcept {
  buffer_ = buffer;
  begin(State::upload_initiate, object, timeout, upload_request(server_, object));
}

void SdoClient::download(ObjectKey object, std::span<const std::byte> value,
                         Time timeout) noexcept {
  value_ = value;
  begin(State::download_initiate, object, timeout,
        download_request(server_, sdo_initiate(object, value)));
}

void SdoClient::begin(State state, ObjectKey object, Time timeout, const Frame& frame) noexcept {
  assert(idle());
  state_ = state;
  object_ = object;
  timeout_ = timeout;
  deadline_ = never;
  toggle_ = false;
  last_segment_sent_ = false;
  done_ = 0;
  announced_.reset();
  to_send_ = frame;
  last_sent_ = {};
  last_received_ = {};
}

void SdoClient::cancel() noexcept {
  if (state_ == State::idle) return;
  const bool begun = last_sent_.length != 0;
  abort(SdoFault::cancelled, abort_code::general_error);
  if (!begun) to_send_.reset();
}

void SdoClient::drop() noexcept {
  state_ = State::idle;
  deadline_ = never;
  to_send_.reset();
  result_.reset();
}

std::optional<SdoResult> SdoClient::take_result() noexcept {
  return std::exchange(result_, std::nullopt);
}

Time SdoClient::deadline() const noexcept { return to_send_ || result_ ? at_once : deadline_; }

void SdoClient::on_time(Time now, Outbox& out) noexcept {
  if (state_ != State::idle && !to_send_ && now >= deadline_) {
    abort(SdoFault::timeout, abort_code::timeout);
  }
  if (!to_send_ || !out.push(*to_send_)) return;
  if (state_ != State::idle) {
    last_sent_ = *to_send_;
    deadline_ = now + timeout_;
  }
  to_send_.reset();
}

void SdoClient::finish(SdoResult result) noexcept {
  state_ = State::idle;
  deadline_ = never;
  given_up_.reset();
  result_ = result;
}

void SdoClient::abort(SdoFault fault, std::uint32_t code) noexcept {
  to_send_ = sdo_abort(sdo_request_cob_id(server_), object_, code);
  finish({.fault = fault, .abort_code = code, .size = done_});
  given_up_ = object_;
}

void SdoClient::on_frame(const Frame& frame, Time /*now*/) noexcept {
  // While a request waits to be sent, every answer belongs to an earlier one.
  if (state_ == State::idle || to_send_ || frame.length < 8) return;
  switch (sdo_answer(frame)) {
    case SdoAnswer::abort:
      return on_abort(frame);
    case SdoAnswer::upload_initiate:
      return on_upload_initiate(frame);
    case SdoAnswer::upload_segment:
      return on_upload_segment(frame);
    case SdoAnswer::download_initiate:
      return on_download_confirmed(frame);
    case SdoAnswer::download_segment:
      return on_download_segment_confirmed(frame);
    case SdoAnswer::block_download:
    case SdoAnswer::block_upload:
    case SdoAnswer::reserved:
      last_received_ = frame;
      return abort(SdoFault::aborted_by_master, abort_code::command_unknown);
  }
}

void SdoClient::on_abort(const Frame& frame) noexcept {
  // Servers put any object into an abort, so all are taken, but for the late one of a transfer that
  // was given up before this one.
  const ObjectKey object = sdo_object(frame);
  if (given_up_ == object && object != object_) return;
  last_received_ = frame;
  finish(
      {.fault = SdoFault::aborted_by_device, .abort_code = sdo_abort_code(frame), .size = done_});
}

void SdoClient::on_upload_initiate(const Frame& frame) noexcept {
  const SdoInitiate begin = decode_initiate(frame);
  if (state_ != State::upload_initiate || begin.object != object_) return;  // a late answer
  last_received_ = frame;
  if (begin.expedited) {
    if (take_bytes(begin.payload())) finish({.size = done_});
    return;
  }
  if (begin.size.value_or(0) > buffer_.size()) {
    return abort(SdoFault::too_long, abort_code::out_of_memory);
  }
  if (begin.size.value_or(0) != 0) announced_ = begin.size;  // 0: some mean "unknown"
  state_ = State::upload_segments;
  to_send_ = upload_segment_request(server_, toggle_);
}

void SdoClient::on_upload_segment(const Frame& frame) noexcept {
  if (state_ == State::upload_initiate || state_ == State::download_initiate) return;  // late
  last_received_ = frame;
  if (state_ != State::upload_segments) {
    return abort(SdoFault::aborted_by_master, abort_code::command_unknown);
  }
  const SdoSegment part = decode_segment(frame);
  if (part.toggle != toggle_) {
    return abort(SdoFault::aborted_by_master, abort_code::toggle_not_alternated);
  }
  if (!take_bytes(part.payload())) return;
  if (announced_ && done_ > *announced_) {
    return abort(SdoFault::aborted_by_master, abort_code::length_too_high);
  }
  if (part.last) {
    if (announced_ && done_ < *announced_) {
      return abort(SdoFault::aborted_by_master, abort_code::length_too_low);
    }
    return finish({.size = done_});
  }
  if (part.size == 0) {  // a server that never ends
    return abort(SdoFault::aborted_by_master, abort_code::length_mismatch);
  }
  toggle_ = !toggle_;
  to_send_ = upload_segment_request(server_, toggle_);
}

bool SdoClient::take_bytes(std::span<const std::uint8_t> bytes) noexcept {
  if (bytes.size() > buffer_.size() - done_) {
    abort(SdoFault::too_long, abort_code::out_of_memory);
    return false;
  }
  for (const std::uint8_t byte : bytes) buffer_[done_++] = std::byte{byte};
  return true;
}

void SdoClient::on_download_confirmed(const Frame& frame) noexcept {
  if (state_ != State::download_initiate || sdo_object(frame) != object_) return;  // a late answer
  last_received_ = frame;
  if (!value_.empty() && value_.size() <= 4) return finish({.size = value_.size()});
  state_ = State::download_segments;
  send_segment();
}

void SdoClient::send_segment() noexcept {
  const SdoSegment part = sdo_segment(value_.subspan(done_), toggle_);
  done_ += part.size;
  last_segment_sent_ = part.last;
  to_send_ = download_segment_request(server_, part);
}

void SdoClient::on_download_segment_confirmed(const Frame& frame) noexcept {
  if (state_ == State::upload_initiate || state_ == State::download_initiate) return;  // late
  last_received_ = frame;
  if (state_ != State::download_segments) {
    return abort(SdoFault::aborted_by_master, abort_code::command_unknown);
  }
  if (sdo_toggle(frame) != toggle_) {
    return abort(SdoFault::aborted_by_master, abort_code::toggle_not_alternated);
  }
  if (last_segment_sent_) return finish({.size = done_});
  toggle_ = !toggle_;
  send_segment();
}

}  // namespace takt
