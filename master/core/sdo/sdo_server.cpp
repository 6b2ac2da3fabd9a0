#include "master/core/sdo/sdo_server.hpp"

#include <algorithm>
#include <utility>

#include "eds_parser/table/waits.hpp"
#include "master/wire/sdo_abort.hpp"
#include "master/wire/sdo_crc.hpp"

namespace takt {

std::optional<OwnDictionary::Order> SdoServer::take_order() noexcept {
  return std::exchange(order_, std::nullopt);
}

void SdoServer::answer(const Frame& frame, State next) noexcept {
  to_send_ = frame;
  state_ = next;
}

void SdoServer::on_time(Time now, Outbox& out) noexcept {
  if (!to_send_ && state_ != State::idle && !sending_block() && now >= deadline_) {
    abort(abort_code::timeout);
  }
  if (!to_send_ && sending_block() && out.room() != 0) to_send_ = next_block_segment();
  if (!to_send_ || !out.push(*to_send_, Answer::none)) return;
  to_send_.reset();
  deadline_ = state_ == State::idle ? never : now + waits::own_server;
}

void SdoServer::on_frame(const Frame& frame, Time now, Orders orders) noexcept {
  if (frame.length < 8 || frame.rtr) return;
  orders_ = orders;
  if (state_ != State::idle) deadline_ = now + waits::own_server;
  if (frame.data[0] == 0x80 ||
      (state_ != State::block_download && sdo_request(frame) == SdoRequest::abort)) {
    state_ = State::idle;  // an abort is never answered
    deadline_ = never;
    to_send_.reset();
    return;
  }
  switch (state_) {
    case State::idle:
      return on_initiate(frame);
    case State::upload:
      return on_upload_segment(frame);
    case State::download:
      return on_download_segment(frame);
    case State::block_download:
      return on_block_segment(frame);
    case State::block_download_end:
      return on_block_download_end(frame);
    case State::block_offered:
    case State::block_upload:
    case State::block_upload_wait:
    case State::block_upload_end:
      return on_block_upload(frame);
  }
}

void SdoServer::on_initiate(const Frame& frame) noexcept {
  // The frame belongs to a block transfer that has already ended, because CAN sometimes repeats a
  // frame. An abort would hit the next request of the client.
  if (is_block_end(frame) || is_block_end_confirm(frame)) return;
  object_ = sdo_object(frame);
  toggle_ = false;
  in_block_ = 0;
  base_ = 0;
  switch (sdo_request(frame)) {
    case SdoRequest::upload_initiate:
      return begin_upload();
    case SdoRequest::download_initiate:
      return begin_download(frame);
    case SdoRequest::block_upload:
      if (is_block_accept(frame)) return begin_block_upload(frame);
      break;
    case SdoRequest::block_download:
      if (is_block_initiate(frame)) return begin_block_download(frame);
      break;
    case SdoRequest::download_segment:
    case SdoRequest::upload_segment:
    case SdoRequest::abort:
    case SdoRequest::reserved:
      break;
  }
  abort(abort_code::command_unknown);
}

void SdoServer::begin_upload() noexcept {
  value_ = dictionary_.read(object_);
  if (value_.abort_code != 0) return abort(value_.abort_code);
  const SdoInitiate begin = sdo_initiate(object_, value_.data());
  answer(upload_answer(channel_.answer, begin), begin.expedited ? State::idle : State::upload);
}

void SdoServer::on_upload_segment(const Frame& frame) noexcept {
  if (sdo_request(frame) != SdoRequest::upload_segment) return abort(abort_code::command_unknown);
  if (sdo_toggle(frame) != toggle_) return abort(abort_code::toggle_not_alternated);
  const SdoSegment part = sdo_segment(value_.data().subspan(base_), toggle_);
  base_ += part.size;
  toggle_ = !toggle_;
  answer(upload_segment_answer(channel_.answer, part), part.last ? State::idle : State::upload);
}

void SdoServer::begin_download(const Frame& frame) noexcept {
  const SdoInitiate begin = decode_initiate(frame);
  value_ = {};
  if (begin.expedited) {
    // Without an indicated size, the value is as long as the object; every writable object has one
    // byte.
    const std::size_t size = begin.size ? begin.payload().size() : 1;
    return write(std::as_bytes(begin.payload()).first(size),
                 download_answer(channel_.answer, object_));
  }
  if (begin.size.value_or(0) > OwnDictionary::longest) return abort(abort_code::length_too_high);
  answer(download_answer(channel_.answer, object_), State::download);
}

void SdoServer::on_download_segment(const Frame& frame) noexcept {
  if (sdo_request(frame) != SdoRequest::download_segment) {
    return abort(abort_code::command_unknown);
  }
  const SdoSegment part = decode_segment(frame);
  if (part.toggle != toggle_) return abort(abort_code::toggle_not_alternated);
  if (!take_bytes(part.payload())) return abort(abort_code::length_too_high);
  const Frame confirmation = download_segment_answer(channel_.answer, toggle_);
  toggle_ = !toggle_;
  if (part.last) return write(value_.data(), confirmation);
  answer(confirmation, State::download);
}

bool SdoServer::take_bytes(std::span<const std::uint8_t> bytes) noexcept {
  if (value_.size + bytes.size() > OwnDictionary::longest) return false;
  for (const std::uint8_t byte : bytes) value_.bytes[value_.size++] = std::byte{byte};
  return true;
}

void SdoServer::write(std::span<const std::byte> value, const Frame& confirmation) noexcept {
  const OwnDictionary::Order order = dictionary_.write(object_, value);
  if (order.abort_code != 0) return abort(order.abort_code);
  if (orders_ == Orders::refused) return abort(abort_code::device_state);
  order_ = order;
  answer(confirmation, State::idle);
}

void SdoServer::begin_block_download(const Frame& frame) noexcept {
  const SdoBlockInitiate begin = decode_block_initiate(frame);
  if (begin.size.value_or(0) > OwnDictionary::longest) return abort(abort_code::length_too_high);
  value_ = {};
  crc_used_ = begin.crc;
  block_segments_ = most_block_segments;
  answer(
      block_accept(channel_.answer, {.object = object_, .crc = true, .segments = block_segments_}),
      State::block_download);
}

void SdoServer::on_block_segment(const Frame& frame) noexcept {
  const SdoBlockSegment part = decode_block_segment(frame);
  if (part.number == 0 || part.number > block_segments_) return abort(abort_code::sequence);
  const bool next = part.number == in_block_ + 1;
  if (next && !take_bytes(part.data)) return abort(abort_code::length_too_high);
  in_block_ = static_cast<std::uint8_t>(in_block_ + (next ? 1 : 0));
  if (!part.last && part.number != block_segments_) return;
  answer(block_confirm(channel_.answer, {.received = in_block_, .segments = block_segments_}),
         next && part.last ? State::block_download_end : State::block_download);
  in_block_ = 0;
}

void SdoServer::on_block_download_end(const Frame& frame) noexcept {
  if (!is_block_end(frame)) return abort(abort_code::command_unknown);
  const SdoBlockEnd end = decode_block_end(frame);
  if (end.unused > value_.size) return abort(abort_code::command_unknown);
  value_.size = static_cast<std::uint8_t>(value_.size - end.unused);
  if (crc_used_ && sdo_crc(value_.data()) != end.crc) return abort(abort_code::crc);
  write(value_.data(), block_end_confirm(channel_.answer));
}

void SdoServer::begin_block_upload(const Frame& frame) noexcept {
  const SdoBlockAccept asked = decode_block_accept(frame);
  if (!valid_block_size(asked.segments)) return abort(abort_code::block_size);
  value_ = dictionary_.read(object_);
  if (value_.abort_code != 0) return abort(value_.abort_code);
  if (value_.size <= asked.threshold) return begin_upload();
  crc_used_ = asked.crc;
  block_segments_ = asked.segments;
  answer(block_initiate(channel_.answer, {.object = object_, .crc = true, .size = value_.size}),
         State::block_offered);
}

void SdoServer::on_block_upload(const Frame& frame) noexcept {
  if (state_ == State::block_offered && is_block_upload_start(frame)) {
    state_ = State::block_upload;
    return;
  }
  if (state_ == State::block_upload_end && is_block_end_confirm(frame)) {
    state_ = State::idle;
    deadline_ = never;
    return;
  }
  const bool awaited = state_ == State::block_upload || state_ == State::block_upload_wait;
  if (!awaited || !is_block_confirm(frame)) return abort(abort_code::command_unknown);
  const SdoBlockConfirm confirm = decode_block_confirm(frame);
  if (confirm.received > in_block_) return abort(abort_code::sequence);
  if (!valid_block_size(confirm.segments)) return abort(abort_code::block_size);
  base_ = std::min<std::size_t>(base_ + confirm.received * segment_bytes, value_.size);
  block_segments_ = confirm.segments;
  in_block_ = 0;
  state_ = State::block_upload;
  if (base_ < value_.size) return;
  const std::size_t in_last = (value_.size - 1U) % segment_bytes + 1;
  answer(block_end(channel_.answer, {.unused = static_cast<std::uint8_t>(segment_bytes - in_last),
                                     .crc = crc_used_ ? sdo_crc(value_.data()) : std::uint16_t{0}}),
         State::block_upload_end);
}

Frame SdoServer::next_block_segment() noexcept {
  const auto left = value_.data().subspan(base_ + in_block_ * segment_bytes);
  ++in_block_;
  if (left.size() <= segment_bytes || in_block_ == block_segments_) {
    state_ = State::block_upload_wait;
  }
  return block_segment(channel_.answer, in_block_, left);
}

}  // namespace takt
