#include "master/core/sdo/sdo_block_upload.hpp"

#include "master/wire/sdo_abort.hpp"
#include "master/wire/sdo_crc.hpp"

namespace takt {

using Kind = SdoStep::Kind;

void SdoBlockUpload::begin(const Begin& begin, std::span<std::byte> buffer) noexcept {
  *this = {};
  setup_ = begin;
  buffer_ = buffer;
  to_send_ = Next::initiate;
}

std::optional<Frame> SdoBlockUpload::to_send() const noexcept {
  const CobId channel = setup_.channel.request;
  switch (to_send_) {
    case Next::nothing:
      return std::nullopt;
    case Next::initiate:
      return block_accept(channel, {.object = setup_.object,
                                    .crc = true,
                                    .segments = setup_.segments,
                                    .threshold = setup_.threshold});
    case Next::start:
      return block_upload_start(channel);
    case Next::confirm:
      return block_confirm(channel, {.received = confirmed_, .segments = setup_.segments});
    case Next::end:
      break;
  }
  return block_end_confirm(channel);
}

SdoStep SdoBlockUpload::on_frame(const Frame& frame) noexcept {
  switch (state_) {
    case State::initiate:
      return on_accept(frame);
    case State::segments:
      return on_segment(frame);
    case State::end:
      return on_end(frame);
    case State::done:
      break;
  }
  return {};
}

SdoStep SdoBlockUpload::on_accept(const Frame& frame) noexcept {
  if (sdo_object(frame) != setup_.object) return {};
  if (sdo_answer(frame) == SdoAnswer::upload_initiate) return {.kind = Kind::plain};
  if (!is_block_initiate(frame)) return {};
  const SdoBlockInitiate begin = decode_block_initiate(frame);
  if (begin.size.value_or(0) > buffer_.size()) return exceeds_buffer();
  if (begin.size.value_or(0) != 0) announced_ = begin.size;  // some servers use 0 for "unknown"
  crc_used_ = begin.crc;
  state_ = State::segments;
  to_send_ = Next::start;
  return {.kind = Kind::goes_on};
}

SdoStep SdoBlockUpload::on_segment(const Frame& frame) noexcept {
  if (to_send_ != Next::nothing) return {};  // the segment comes too early, or is a repetition
  const SdoBlockSegment part = decode_block_segment(frame);
  if (part.number == 0 || part.number > setup_.segments) return violation(abort_code::sequence);
  if (part.number == in_sequence_ + 1) {
    if (held_back_ != Held::nothing && !commit(segment_bytes)) return exceeds_buffer();
    if (announced_ && done_ >= *announced_) return violation(abort_code::length_too_high);
    held_ = part.data;
    held_back_ = part.last ? Held::last_segment : Held::segment;
    in_sequence_ = part.number;
    asked_again_ = false;
  }
  // Even if segments were missed, the server stops here and waits.
  if (part.last || part.number == setup_.segments) {
    if (in_sequence_ == 0 && ++stalled_blocks_ == most_stalled_blocks) {
      return violation(abort_code::sequence);
    }
    if (in_sequence_ != 0) stalled_blocks_ = 0;
    confirm();
  }
  return {.kind = Kind::goes_on};
}

void SdoBlockUpload::confirm() noexcept {
  confirmed_ = in_sequence_;
  in_sequence_ = 0;
  to_send_ = Next::confirm;
  if (held_back_ == Held::last_segment) state_ = State::end;
}

bool SdoBlockUpload::confirm_after_silence() noexcept {
  if (!in_sub_block()) return false;
  confirm();
  asked_again_ = true;
  return true;
}

SdoStep SdoBlockUpload::on_end(const Frame& frame) noexcept {
  const bool confirmed = to_send_ == Next::nothing;
  if (!confirmed || !is_block_end(frame))
    return {};  // The device has sent this segment before it has received the confirmation.
  const SdoBlockEnd end = decode_block_end(frame);
  if (repeats_last(frame) && end.crc != crc_with_held(end)) return {};
  if (!commit(segment_bytes - end.unused)) return exceeds_buffer();
  if (crc_used_ && end.crc != crc_) return violation(abort_code::crc);
  if (announced_ && done_ > *announced_) return violation(abort_code::length_too_high);
  state_ = State::done;
  to_send_ = Next::end;
  return {.kind = Kind::done};
}

/// Returns true if the frame repeats the last segment. With some segment numbers, such a frame
/// looks like the end of the transfer.
bool SdoBlockUpload::repeats_last(const Frame& frame) const noexcept {
  const SdoBlockSegment part = decode_block_segment(frame);
  return part.last && part.number == confirmed_ && part.data == held_;
}

/// Returns the CRC that the end of the transfer must carry.
std::uint16_t SdoBlockUpload::crc_with_held(const SdoBlockEnd& end) const noexcept {
  return crc_used_ ? sdo_crc(std::span{held_}.first(segment_bytes - end.unused), crc_) : 0;
}

bool SdoBlockUpload::commit(std::size_t bytes) noexcept {
  if (bytes > buffer_.size() - done_) return false;
  const auto data = std::span{held_}.first(bytes);
  for (const std::uint8_t byte : data) buffer_[done_++] = std::byte{byte};
  if (crc_used_) crc_ = sdo_crc(data, crc_);
  held_back_ = Held::nothing;
  return true;
}

}  // namespace takt
