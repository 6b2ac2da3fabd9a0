#include "master/trace/block_follower.hpp"

#include <algorithm>

#include "master/wire/sdo_crc.hpp"

namespace takt {
namespace {

constexpr std::size_t most_kept = 4096;  // bytes of one value that are kept

bool all_zero(std::span<const std::uint8_t> bytes) {
  return std::ranges::all_of(bytes, [](std::uint8_t byte) { return byte == 0; });
}

}  // namespace

void BlockFollower::begin(ObjectKey object, Direction direction) noexcept {
  *this = {};
  running_ = true;
  object_ = object;
  direction_ = direction;
}

BlockFollower::Part BlockFollower::from_source(const Frame& frame) {
  if (segments_) return segment(frame);
  if (is_block_end(frame)) return end(frame);
  if (!is_block_initiate(frame)) return Part::unknown;
  const SdoBlockInitiate begin = decode_block_initiate(frame);
  (uploads() ? crc_used_ : crc_offered_) = begin.crc && (!uploads() || crc_offered_);
  return Part::initiate;
}

BlockFollower::Part BlockFollower::from_sink(const Frame& frame) {
  if (is_block_confirm(frame)) return confirm(frame);
  if (is_block_upload_start(frame)) {
    segments_ = true;
    return Part::start;
  }
  if (is_block_end_confirm(frame)) {
    running_ = false;
    return Part::end_confirm;
  }
  const SdoBlockAccept accept = decode_block_accept(frame);
  (uploads() ? crc_offered_ : crc_used_) = accept.crc && (uploads() || crc_offered_);
  segments_ = !uploads();
  return Part::accept;
}

BlockFollower::Part BlockFollower::segment(const Frame& frame) {
  // After a gap, a frame counts as the end of the transfer if it looks like an end and its unused
  // bytes are zero. The last segment was then not seen.
  if (gap_ && is_block_end(frame) && all_zero(std::span{frame.data}.subspan(3))) return end(frame);
  const SdoBlockSegment part = decode_block_segment(frame);
  // The confirmation of the sub-block was not seen.
  if (part.number == 1 && !sub_block_.empty()) lose_track();
  if (part.last) last_number_ = part.number;
  if (part.number == sub_block_.size() + 1) sub_block_.push_back(part);
  return Part::segment;
}

bool BlockFollower::is_over(const Frame& frame) const noexcept {
  const unsigned number = frame.data[0] & 0x7FU;
  if (number == sub_block_.size() + 1 || number == 1) return false;
  const bool reads = frame.data[0] == 0x40 || is_block_accept(frame);
  return reads && all_zero(std::span{frame.data}.subspan(is_block_accept(frame) ? 6 : 4));
}

BlockFollower::Part BlockFollower::confirm(const Frame& frame) {
  const SdoBlockConfirm taken = decode_block_confirm(frame);
  const std::size_t sent = sub_block_.size();
  for (std::size_t i = 0; i < taken.received && i < sent; ++i) {
    if (held_) absorb(held_->data);
    held_ = sub_block_[i];
  }
  to_repeat_ = taken.received < sent ? sent - taken.received : 0;
  if (taken.received > sent) lose_track();
  segments_ = !last_number_ || taken.received < *last_number_;
  last_number_.reset();
  sub_block_.clear();
  return Part::confirm;
}

BlockFollower::Part BlockFollower::end(const Frame& frame) {
  const SdoBlockEnd reported = decode_block_end(frame);
  if (held_) absorb(std::span{held_->data}.first(segment_bytes - reported.unused));
  return Part::end;
}

/// Notes that the receiver has taken more segments than this recording shows.
void BlockFollower::lose_track() noexcept {
  gap_ = true;
  whole_ = false;
  sub_block_.clear();
  value_.clear();
}

void BlockFollower::absorb(std::span<const std::uint8_t> bytes) {
  crc_ = sdo_crc(bytes, crc_);
  if (value_.size() + bytes.size() > most_kept) {
    whole_ = false;
    return;
  }
  value_.insert(value_.end(), bytes.begin(), bytes.end());
}

}  // namespace takt
