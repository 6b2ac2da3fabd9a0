#include "master/explain/frame/sdo_text.hpp"

#include <fmt/format.h>
#include <optional>

#include "master/explain/frame/frame_value_text.hpp"
#include "master/explain/frame/service_texts.hpp"
#include "master/wire/sdo_abort.hpp"
#include "master/wire/sdo_codec.hpp"

namespace takt {
namespace {

constexpr std::size_t most_shown = 4096;  // bytes of one value that are shown

std::string size_text(const std::optional<std::uint32_t>& size) {
  return size ? fmt::format("{} bytes", *size) : "of unknown size";
}

std::string wrong_length(const Frame& frame) {
  return fmt::format("frame of {} bytes instead of 8", frame.length);
}

std::string unknown_command(const Frame& frame) {
  return "unknown command " + bytes_text(std::span{frame.data}.first(1));
}

constexpr const char* lost_block = "part of a block transfer, beginning not seen";

}  // namespace

std::string SdoText::object() const { return names_->object(node_, follower_.transfer().object); }

/// Returns a value with its meaning: `1591 (0x637)`, `1073742213 (0x40000185): 0x185, valid, no
/// RTR`.
std::string SdoText::value(ObjectKey key, std::span<const std::uint8_t> bytes) const {
  std::string text = value_text(names_->type(node_, key), bytes);
  const std::string meaning = object_meaning(*names_, node_, key, bytes);
  return meaning.empty() ? text : text + ": " + meaning;
}

std::string_view SdoText::toggle_text() const noexcept {
  return follower_.repeats_toggle() ? ", the toggle bit is wrong" : "";
}

/// Describes the frame that names the object and, in an expedited transfer, holds its value.
std::string SdoText::initiate(const Frame& frame, const char* verb) const {
  const SdoInitiate begin = decode_initiate(frame);
  const std::string name = names_->object(node_, begin.object);
  if (begin.expedited) {
    return fmt::format("{} {} = {}", verb, name, value(begin.object, begin.payload()));
  }
  return fmt::format("{} {}, {} in segments", verb, name, size_text(begin.size));
}

std::string SdoText::segment(const Frame& frame, const char* verb) const {
  const SdoSegment part = decode_segment(frame);
  if (follower_.is_stray()) {
    return fmt::format("segment of {} bytes, beginning not seen", part.size);
  }
  const SeenTransfer& transfer = follower_.transfer();
  const std::string text =
      fmt::format("segment of {}, {} bytes{}", object(), part.size, toggle_text());
  if (!part.last) return text;
  std::string length;
  if (transfer.announced && *transfer.announced != transfer.length) {
    length = fmt::format(", {} bytes, but {} were announced", transfer.length, *transfer.announced);
  }
  if (transfer.length > most_shown) return text + ", the last" + length;
  return fmt::format("{} {} = {} (last segment{}{})", verb, object(),
                     value(transfer.object, transfer.value), toggle_text(), length);
}

std::string SdoText::abort(const Frame& frame) const {
  const std::uint32_t code = sdo_abort_code(frame);
  return fmt::format("ABORT {}: {:04X} {:04X} {}", names_->object(node_, sdo_object(frame)),
                     code >> 16, code & 0xFFFF, abort_text(code));
}

std::string SdoText::block(BlockFollower::Part part, const Frame& frame) const {
  using enum BlockFollower::Part;
  const SeenTransfer& transfer = follower_.transfer();
  const std::string name = object();
  switch (part) {
    case initiate: {
      const SdoBlockInitiate begin = decode_block_initiate(frame);
      return fmt::format("{} {}{}, {}{}", block_verb(), name,
                         follower_.block().uploads() ? " accepted" : "", size_text(begin.size),
                         begin.crc ? ", with CRC" : "");
    }
    case accept:
      return block_accept(frame, name);
    case start:
      return fmt::format("block upload {}: start", name);
    case segment: {
      const SdoBlockSegment seen = decode_block_segment(frame);
      return fmt::format("block segment {} of {}{}", seen.number, name,
                         seen.last ? ", the last" : "");
    }
    case confirm:
      return block_confirm(frame);
    case end:
      return block_end(frame, name);
    case end_confirm: {
      const std::string text = fmt::format("{} {} done", block_verb(), name);
      const bool whole = transfer.extent == SeenTransfer::Extent::whole;
      return whole ? text + " = " + value(transfer.object, transfer.value) : text;
    }
    case unknown:
      break;
  }
  return fmt::format("{} of {}: unknown command", block_verb(), name);
}

std::string SdoText::block_accept(const Frame& frame, const std::string& name) const {
  const SdoBlockAccept accept = decode_block_accept(frame);
  const bool uploads = follower_.block().uploads();
  std::string text = fmt::format("{} {}{}, {} segments a block", block_verb(), name,
                                 uploads ? "" : " accepted", accept.segments);
  if (uploads && accept.threshold != 0) {
    text += fmt::format(", in segments up to {} bytes", accept.threshold);
  }
  return text;
}

std::string SdoText::block_confirm(const Frame& frame) const {
  const SdoBlockConfirm taken = decode_block_confirm(frame);
  const std::size_t again = follower_.block().to_repeat();
  return fmt::format("{}: {} segments taken{}", block_verb(), taken.received,
                     again == 0 ? "" : fmt::format(", {} to be repeated", again));
}

std::string SdoText::block_end(const Frame& frame, const std::string& name) const {
  const BlockFollower& block = follower_.block();
  const std::uint16_t reported = decode_block_end(frame).crc;
  std::string text = fmt::format("end of {} {}", block_verb(), name);
  if (!block.uses_crc()) return text;
  text += fmt::format(", CRC {:04X}", reported);
  if (block.has_gap()) return text + " can't be checked: some segments are not in this recording";
  if (reported != block.crc()) text += fmt::format(" is wrong, {:04X} would be right", block.crc());
  return text;
}

std::string SdoText::request(const Frame& frame) {
  if (frame.length != 8) return wrong_length(frame);
  follower_.request(frame);
  if (const auto part = follower_.block_part()) return block(*part, frame);
  switch (sdo_request(frame)) {
    case SdoRequest::download_segment:
      return segment(frame, "write");
    case SdoRequest::download_initiate:
      return initiate(frame, "write");
    case SdoRequest::upload_initiate:
      return fmt::format("read {}", object());
    case SdoRequest::upload_segment:
      if (follower_.is_stray()) return "next segment, beginning not seen";
      return fmt::format("next segment of {}{}", object(), toggle_text());
    case SdoRequest::abort:
      return abort(frame);
    case SdoRequest::block_upload:
    case SdoRequest::block_download:
      return lost_block;
    case SdoRequest::reserved:
      break;
  }
  return unknown_command(frame);
}

std::string SdoText::answer(const Frame& frame) {
  if (frame.length != 8) return wrong_length(frame);
  follower_.answer(frame);
  if (const auto part = follower_.block_part()) return block(*part, frame);
  switch (sdo_answer(frame)) {
    case SdoAnswer::upload_segment:
      return segment(frame, "read");
    case SdoAnswer::download_segment:
      if (follower_.is_stray()) return "segment taken, beginning not seen";
      return fmt::format("segment taken{}", toggle_text());
    case SdoAnswer::upload_initiate:
      return initiate(frame, "read");
    case SdoAnswer::download_initiate:
      if (follower_.expects_segments() && !follower_.is_stray()) {
        return fmt::format("write {} accepted, segments follow", object());
      }
      return fmt::format("written {}", names_->object(node_, sdo_object(frame)));
    case SdoAnswer::abort:
      return abort(frame);
    case SdoAnswer::block_download:
    case SdoAnswer::block_upload:
      return lost_block;
    case SdoAnswer::reserved:
      break;
  }
  return unknown_command(frame);
}

}  // namespace takt
