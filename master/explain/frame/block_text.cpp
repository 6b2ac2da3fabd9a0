#include "master/explain/frame/block_text.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <utility>

#include "master/wire/sdo_crc.hpp"

namespace takt {
namespace {

constexpr std::size_t most_kept = 4096;  // bytes of one value that are kept

std::string size_text(const std::optional<std::uint32_t>& size) {
  return size ? fmt::format("{} bytes", *size) : "of unknown size";
}

}  // namespace

void BlockText::begin(ObjectKey object, Direction direction) noexcept {
  *this = {};
  running_ = true;
  object_ = object;
  direction_ = direction;
}

std::string BlockText::from_source(const Frame& frame, const std::string& name) {
  if (segments_) return segment(frame, name);
  if (is_block_end(frame)) return end(frame, name);
  if (!is_block_initiate(frame)) return fmt::format("{} of {}: unknown command", verb(), name);
  const SdoBlockInitiate begin = decode_block_initiate(frame);
  (uploads() ? crc_used_ : crc_offered_) = begin.crc && (!uploads() || crc_offered_);
  const char* accepted = uploads() ? " accepted" : "";
  return fmt::format("{} {}{}, {}{}", verb(), name, accepted, size_text(begin.size),
                     begin.crc ? ", with CRC" : "");
}

std::string BlockText::from_sink(const Frame& frame, const std::string& name) {
  if (is_block_confirm(frame)) return confirm(frame);
  if (is_block_upload_start(frame)) {
    segments_ = true;
    return fmt::format("block upload {}: start", name);
  }
  if (is_block_end_confirm(frame)) {
    running_ = false;
    return fmt::format("{} {} done", verb(), name);
  }
  const SdoBlockAccept accept = decode_block_accept(frame);
  if (uploads()) {
    crc_offered_ = accept.crc;
    std::string text = fmt::format("block upload {}, {} segments a block", name, accept.segments);
    if (accept.threshold != 0) {
      text += fmt::format(", in segments up to {} bytes", accept.threshold);
    }
    return text;
  }
  crc_used_ = crc_offered_ && accept.crc;
  segments_ = true;
  return fmt::format("block download {} accepted, {} segments a block", name, accept.segments);
}

std::string BlockText::segment(const Frame& frame, const std::string& name) {
  // After a gap, a frame that looks like an end with its zeros is the end; the last segment was not
  // seen.
  const bool zeros =
      std::ranges::all_of(std::span{frame.data}.subspan(3), [](auto b) { return b == 0; });
  if (gap_ && is_block_end(frame) && zeros) return end(frame, name);
  const SdoBlockSegment part = decode_block_segment(frame);
  if (part.number == 1 && !sub_block_.empty()) lose_track();  // confirmation not seen
  if (part.last) last_number_ = part.number;
  if (part.number == sub_block_.size() + 1) sub_block_.push_back(part);
  return fmt::format("block segment {} of {}{}", part.number, name, part.last ? ", the last" : "");
}

bool BlockText::is_over(const Frame& frame) const noexcept {
  const unsigned number = frame.data[0] & 0x7FU;
  if (number == sub_block_.size() + 1 || number == 1) return false;
  const std::span rest = std::span{frame.data}.subspan(is_block_accept(frame) ? 6 : 4);
  const bool reads = frame.data[0] == 0x40 || is_block_accept(frame);
  return reads && std::ranges::all_of(rest, [](auto b) { return b == 0; });
}

std::string BlockText::confirm(const Frame& frame) {
  const SdoBlockConfirm taken = decode_block_confirm(frame);
  const std::size_t sent = sub_block_.size();
  for (std::size_t i = 0; i < taken.received && i < sent; ++i) {
    if (held_) absorb(held_->data);
    held_ = sub_block_[i];
  }
  if (taken.received > sent) lose_track();
  segments_ = !last_number_ || taken.received < *last_number_;
  last_number_.reset();
  sub_block_.clear();
  std::string text = fmt::format("{}: {} segments taken", verb(), taken.received);
  if (taken.received < sent) text += fmt::format(", {} to be repeated", sent - taken.received);
  return text;
}

std::string BlockText::end(const Frame& frame, const std::string& name) {
  const SdoBlockEnd reported = decode_block_end(frame);
  if (held_) absorb(std::span{held_->data}.first(segment_bytes - reported.unused));
  std::string text = fmt::format("end of {} {}", verb(), name);
  if (!crc_used_) return text;
  text += fmt::format(", CRC {:04X}", reported.crc);
  if (gap_) return text + " can't be checked: some segments are not in this recording";
  if (reported.crc != crc_) text += fmt::format(" is wrong, {:04X} would be right", crc_);
  return text;
}

/// Notes that the receiver has taken more segments than this recording shows.
void BlockText::lose_track() noexcept {
  gap_ = true;
  whole_ = false;
  sub_block_.clear();
  value_.clear();
}

void BlockText::absorb(std::span<const std::uint8_t> bytes) {
  crc_ = sdo_crc(bytes, crc_);
  if (value_.size() + bytes.size() > most_kept) {
    whole_ = false;
    return;
  }
  value_.insert(value_.end(), bytes.begin(), bytes.end());
}

}  // namespace takt
