#include "master/core/sdo/sdo_upload.hpp"

namespace takt {

using Kind = SdoStep::Kind;

SdoQuestion SdoUpload::question() const noexcept {
  return {.answer = initiates() ? SdoAnswer::upload_initiate : SdoAnswer::upload_segment,
          .toggle = toggle_,
          .object = object_};
}

SdoStep SdoUpload::on_initiate(const Frame& frame) noexcept {
  const SdoInitiate begin = decode_initiate(frame);
  if (begin.expedited) return take(begin.payload()) ? SdoStep{Kind::done} : exceeds_buffer();
  if (begin.size.value_or(0) > buffer_.size()) return exceeds_buffer();
  if (begin.size.value_or(0) != 0) announced_ = begin.size;  // some servers use 0 for "unknown"
  state_ = State::segments;
  request_segment();
  return {Kind::goes_on};
}

SdoStep SdoUpload::on_segment(const Frame& frame) noexcept {
  const SdoSegment part = decode_segment(frame);
  if (!take(part.payload())) return exceeds_buffer();
  if (announced_ && moved_ > *announced_) return violation(abort_code::length_too_high);
  if (part.last) return {Kind::done};
  if (part.size == 0) return violation(abort_code::length_mismatch);  // the server would never end
  toggle_ = !toggle_;
  request_segment();
  return {Kind::goes_on};
}

/// Returns false if the bytes do not fit into the buffer.
bool SdoUpload::take(std::span<const std::uint8_t> bytes) noexcept {
  if (bytes.size() > buffer_.size() - moved_) return false;
  for (const std::uint8_t byte : bytes) buffer_[moved_++] = std::byte{byte};
  return true;
}

}  // namespace takt
