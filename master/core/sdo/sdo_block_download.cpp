#include "master/core/sdo/sdo_block_download.hpp"

#include <algorithm>

#include "master/wire/sdo_abort.hpp"
#include "master/wire/sdo_crc.hpp"

namespace takt {

void SdoBlockDownload::begin(SdoChannel channel, ObjectKey object,
                             std::span<const std::byte> value) noexcept {
  *this = {};
  channel_ = channel;
  object_ = object;
  value_ = value;
}

std::optional<Frame> SdoBlockDownload::to_send() const noexcept {
  if (waits_) return std::nullopt;
  switch (state_) {
    case State::initiate:
      return block_initiate(
          channel_.request,
          {.object = object_, .crc = true, .size = static_cast<std::uint32_t>(value_.size())});
    case State::segments:
      return block_segment(channel_.request, static_cast<std::uint8_t>(sent_in_block_ + 1),
                           value_.subspan(offset()));
    case State::end:
      break;
  }
  const std::size_t in_last = value_.empty() ? 0 : (value_.size() - 1) % segment_bytes + 1;
  return block_end(channel_.request, {.unused = static_cast<std::uint8_t>(segment_bytes - in_last),
                                      .crc = crc_used_ ? crc_ : std::uint16_t{0}});
}

bool SdoBlockDownload::answered() const noexcept {
  return state_ != State::segments || sent_in_block_ + 1 == block_segments_ ||
         offset() + segment_bytes >= value_.size();
}

void SdoBlockDownload::sent() noexcept {
  waits_ = answered();
  if (state_ != State::segments) return;
  const std::size_t end = std::min(offset() + segment_bytes, value_.size());
  if (crc_used_ && end > summed_) {  // a repeated segment is not counted again
    crc_ = sdo_crc(value_.subspan(summed_, end - summed_), crc_);
    summed_ = end;
  }
  ++sent_in_block_;
}

SdoStep SdoBlockDownload::on_frame(const Frame& frame) noexcept {
  using Kind = SdoStep::Kind;
  if (state_ != State::initiate && accepts(frame)) return {};  // a repeated frame
  switch (state_) {
    case State::initiate:
      return on_accept(frame);
    case State::segments:
      if (is_block_confirm(frame)) return on_confirm(frame);
      break;
    case State::end:
      if (is_block_end_confirm(frame)) return {.kind = Kind::done};
      if (is_block_confirm(frame)) return {};  // a repeated frame
      break;
  }
  return violation(abort_code::command_unknown);
}

bool SdoBlockDownload::accepts(const Frame& frame) const noexcept {
  return is_block_accept(frame) && sdo_object(frame) == object_;
}

SdoStep SdoBlockDownload::on_accept(const Frame& frame) noexcept {
  if (!accepts(frame)) return {};
  const SdoBlockAccept accept = decode_block_accept(frame);
  if (!valid_block_size(accept.segments)) return violation(abort_code::block_size);
  crc_used_ = accept.crc;
  block_segments_ = accept.segments;
  state_ = State::segments;
  waits_ = false;
  return {.kind = SdoStep::Kind::goes_on};
}

/// Handles a confirmation. It may come in the middle of a sub-block, because some servers confirm
/// as soon as a segment is missing.
SdoStep SdoBlockDownload::on_confirm(const Frame& frame) noexcept {
  const SdoBlockConfirm confirm = decode_block_confirm(frame);
  if (confirm.received > sent_in_block_) {
    if (confirm == newest_) return {};  // the repeated confirmation of the previous sub-block
    return violation(abort_code::sequence);
  }
  if (!valid_block_size(confirm.segments)) return violation(abort_code::block_size);
  confirmed_ = std::min(confirmed_ + confirm.received * segment_bytes, value_.size());
  stalled_blocks_ =
      confirm.received == 0 ? static_cast<std::uint8_t>(stalled_blocks_ + 1) : std::uint8_t{0};
  if (stalled_blocks_ == most_stalled_blocks) return violation(abort_code::sequence);
  newest_ = confirm;
  block_segments_ = confirm.segments;
  sent_in_block_ = 0;
  waits_ = false;
  if (confirm.received != 0 && confirmed_ == value_.size()) state_ = State::end;
  return {.kind = SdoStep::Kind::goes_on};
}

}  // namespace takt
