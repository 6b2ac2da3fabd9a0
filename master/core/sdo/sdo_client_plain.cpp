#include "master/core/sdo/sdo_client.hpp"
#include "master/wire/sdo_abort.hpp"

// Expedited and segmented transfers. CiA 301, 7.2.4.3.3 to 7.2.4.3.8.

namespace takt {

/// Aborts the transfer because of an answer that does not fit the request. An answer that may
/// belong to an earlier request is ignored: the answer to a transfer that was given up may come
/// late, and CAN sometimes repeats a frame. If nothing else comes until the time-out, the transfer
/// is aborted because of that answer.
void SdoClient::on_wrong_answer(const Frame& frame) noexcept {
  if (late_now_) return;
  const bool earlier = late_possible_ || frame == previous_answer_ || frame == last_received_;
  last_received_ = frame;
  if (!earlier) return abort(SdoFault::aborted_by_master, abort_code::command_unknown);
  unfit_ = true;
}

/// Notes the answer for an object that neither this request nor an earlier one has asked for.
void SdoClient::on_other_object(const Frame& frame) noexcept {
  if (late_now_ || frame == previous_answer_) return;
  last_received_ = frame;
  answered_ = sdo_object(frame);
}

void SdoClient::on_upload_initiate(const Frame& frame) noexcept {
  const SdoInitiate begin = decode_initiate(frame);
  if (in_initiate() && begin.object != object_) return on_other_object(frame);
  if (state_ != State::upload_initiate) return on_wrong_answer(frame);
  heard(frame);
  if (begin.expedited) {
    if (take_bytes(begin.payload())) finish({.size = done_});
    return;
  }
  if (begin.size.value_or(0) > buffer_.size()) {
    return abort(SdoFault::too_long, abort_code::out_of_memory);
  }
  if (begin.size.value_or(0) != 0) announced_ = begin.size;  // some use 0 for "unknown"
  state_ = State::upload_segments;
  to_send_ = upload_segment_request(channel_.request, toggle_);
}

/// A late segment of an earlier try has the wrong toggle bit, and the segment before it may have
/// been late too. Then the server is too slow, and the bytes that it has sent are of no use.
void SdoClient::on_wrong_toggle() noexcept {
  if (late_now_) return give_up_late();
  abort(SdoFault::aborted_by_master, abort_code::toggle_not_alternated);
}

void SdoClient::on_upload_segment(const Frame& frame) noexcept {
  if (state_ != State::upload_segments) return on_wrong_answer(frame);
  last_received_ = frame;
  const SdoSegment part = decode_segment(frame);
  if (part.toggle != toggle_) return on_wrong_toggle();
  if (!take_bytes(part.payload())) return;
  if (announced_ && done_ > *announced_) {
    return abort(SdoFault::aborted_by_master, abort_code::length_too_high);
  }
  // Some devices announce the size of the buffer of a string and send only the string.
  if (part.last) return finish({.size = done_, .shortened = done_ < announced_.value_or(0)});
  if (part.size == 0) {  // the server would never end
    return abort(SdoFault::aborted_by_master, abort_code::length_mismatch);
  }
  toggle_ = !toggle_;
  to_send_ = upload_segment_request(channel_.request, toggle_);
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
  if (in_initiate() && sdo_object(frame) != object_) return on_other_object(frame);
  if (state_ != State::download_initiate) return on_wrong_answer(frame);
  heard(frame);
  if (!value_.empty() && value_.size() <= 4) return finish({.size = value_.size()});
  state_ = State::download_segments;
  send_segment();
}

void SdoClient::send_segment() noexcept {
  const SdoSegment part = sdo_segment(value_.subspan(done_), toggle_);
  done_ += part.size;
  last_segment_sent_ = part.last;
  to_send_ = download_segment_request(channel_.request, part);
}

void SdoClient::on_download_segment_confirmed(const Frame& frame) noexcept {
  if (state_ != State::download_segments) return on_wrong_answer(frame);
  last_received_ = frame;
  if (sdo_toggle(frame) != toggle_) return on_wrong_toggle();
  if (last_segment_sent_) return finish({.size = done_});
  toggle_ = !toggle_;
  send_segment();
}

}  // namespace takt
