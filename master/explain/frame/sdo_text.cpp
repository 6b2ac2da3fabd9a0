#include "master/explain/frame/sdo_text.hpp"

#include <fmt/format.h>

#include "master/explain/frame/frame_value_text.hpp"
#include "master/explain/frame/object_meaning.hpp"
#include "master/wire/sdo_abort.hpp"
#include "master/wire/sdo_codec.hpp"

namespace takt {
namespace {

constexpr std::size_t most_kept = 4096;  // bytes of one value that are kept

}  // namespace

void SdoText::keep(std::span<const std::uint8_t> bytes) {
  transfer_.length += bytes.size();
  if (transfer_.length > most_kept) {
    transfer_.truncated = true;
    return;
  }
  transfer_.value.insert(transfer_.value.end(), bytes.begin(), bytes.end());
}

std::string SdoText::object() const { return names_->object(node_, transfer_.object); }

/// Returns a value with its meaning: `1591 (0x637)`, `1073742213 (0x40000185): 0x185, valid, no
/// RTR`.
std::string SdoText::value(ObjectKey key, std::span<const std::uint8_t> bytes) const {
  std::string text = value_text(names_->type(node_, key), bytes);
  const std::string meaning = object_meaning(*names_, node_, key, bytes);
  return meaning.empty() ? text : text + ": " + meaning;
}

/// Checks the toggle bit of a segment frame, which must change from frame to frame of the same
/// side. Empty if it is right.
std::string_view SdoText::toggle_text(std::optional<bool>& last, const Frame& frame) {
  const bool toggle = sdo_toggle(frame);
  const bool wrong = toggle != !last.value_or(true);
  last = toggle;
  return wrong ? ", the toggle bit is wrong" : "";
}

/// Describes the frame that names the object and, in an expedited transfer, holds its value.
std::string SdoText::initiate(const Frame& frame, const char* verb) {
  const SdoInitiate begin = decode_initiate(frame);
  transfer_ = {.object = begin.object, .open = !begin.expedited, .announced = begin.size};
  if (begin.expedited) {
    return fmt::format("{} {} = {}", verb, object(), value(begin.object, begin.payload()));
  }
  const std::string size = begin.size ? fmt::format("{} bytes", *begin.size) : "of unknown size";
  return fmt::format("{} {}, {} in segments", verb, object(), size);
}

std::string SdoText::segment(const Frame& frame, std::string_view toggled, const char* verb) {
  const SdoSegment part = decode_segment(frame);
  if (!transfer_.open) return fmt::format("segment of {} bytes, beginning not seen", part.size);
  if (toggled.empty()) keep(part.payload());
  const std::string text = fmt::format("segment of {}, {} bytes{}", object(), part.size, toggled);
  if (!part.last) return text;
  transfer_.open = false;
  std::string length;
  if (transfer_.announced && *transfer_.announced != transfer_.length) {
    length =
        fmt::format(", {} bytes, but {} were announced", transfer_.length, *transfer_.announced);
  }
  if (transfer_.truncated) return text + ", the last" + length;
  return fmt::format("{} {} = {} (last segment{}{})", verb, object(),
                     value(transfer_.object, transfer_.value), toggled, length);
}

std::string SdoText::abort(const Frame& frame) {
  transfer_ = {.object = sdo_object(frame)};
  const std::uint32_t code = sdo_abort_code(frame);
  return fmt::format("ABORT {}: {:04X} {:04X} {}", object(), code >> 16, code & 0xFFFF,
                     abort_text(code));
}

/// Begins a block transfer if the frame is the request of a block download or a block upload.
/// Returns false for all other frames.
bool SdoText::begins_block(const Frame& frame) {
  const SdoRequest command = sdo_request(frame);
  const bool download = command == SdoRequest::block_download && is_block_initiate(frame);
  const bool upload = command == SdoRequest::block_upload && is_block_accept(frame);
  if (!download && !upload) return false;
  block_.begin(sdo_object(frame),
               upload ? BlockText::Direction::upload : BlockText::Direction::download);
  return true;
}

/// Describes a frame of a running block transfer. Its sender is the side that sends the data of a
/// transfer in the direction `data_go`.
std::string SdoText::block(BlockText::Direction data_go, const Frame& frame) {
  const std::string name = names_->object(node_, block_.object());
  const bool source = block_.uploads() == (data_go == BlockText::Direction::upload);
  std::string text = source ? block_.from_source(frame, name) : block_.from_sink(frame, name);
  if (block_.running() || !block_.has_value()) return text;
  const std::vector<std::uint8_t> whole = block_.take_value();
  return text + " = " + value(block_.object(), whole);
}

/// Gives up a block transfer whose end was not seen.
void SdoText::lose_block() noexcept {
  if (!block_.running()) return;
  block_.stop();
  transfer_ = {};
}

std::string SdoText::request(const Frame& frame) {
  if (frame.length != 8) return fmt::format("frame of {} bytes instead of 8", frame.length);
  const SdoRequest command = sdo_request(frame);
  const bool segments = block_.in_segments() && !block_.is_over(frame);
  const bool part = block_.uploads()
                        ? command == SdoRequest::block_upload && !is_block_accept(frame)
                        : segments || is_block_end(frame);
  const bool continues = block_.running() && part && frame.data[0] != 0x80;
  if (continues || begins_block(frame)) return block(BlockText::Direction::download, frame);
  lose_block();
  switch (command) {
    case SdoRequest::download_segment:
      return segment(frame, toggle_text(transfer_.asked_toggle, frame), "write");
    case SdoRequest::download_initiate:
      return initiate(frame, "write");
    case SdoRequest::upload_initiate:
      transfer_ = {.object = sdo_object(frame)};
      return fmt::format("read {}", object());
    case SdoRequest::upload_segment:
      if (!transfer_.open) return "next segment, beginning not seen";
      return fmt::format("next segment of {}{}", object(),
                         toggle_text(transfer_.asked_toggle, frame));
    case SdoRequest::abort:
      return abort(frame);
    case SdoRequest::block_upload:
    case SdoRequest::block_download:
      return "part of a block transfer, beginning not seen";
    case SdoRequest::reserved:
      break;
  }
  return "unknown command " + bytes_text(std::span{frame.data}.first(1));
}

std::string SdoText::answer(const Frame& frame) {
  if (frame.length != 8) return fmt::format("frame of {} bytes instead of 8", frame.length);
  const SdoAnswer command = sdo_answer(frame);
  const bool part = block_.uploads() ? block_.in_segments() || command == SdoAnswer::block_upload
                                     : command == SdoAnswer::block_download;
  if (block_.running() && part && frame.data[0] != 0x80) {
    return block(BlockText::Direction::upload, frame);
  }
  lose_block();
  switch (command) {
    case SdoAnswer::upload_segment:
      return segment(frame, toggle_text(transfer_.answered_toggle, frame), "read");
    case SdoAnswer::download_segment:
      if (!transfer_.asked_toggle) return "segment taken, beginning not seen";
      return fmt::format("segment taken{}", toggle_text(transfer_.answered_toggle, frame));
    case SdoAnswer::upload_initiate:
      return initiate(frame, "read");
    case SdoAnswer::download_initiate:
      if (transfer_.open && transfer_.object == sdo_object(frame)) {
        return fmt::format("write {} accepted, segments follow", object());
      }
      return fmt::format("written {}", names_->object(node_, sdo_object(frame)));
    case SdoAnswer::abort:
      return abort(frame);
    case SdoAnswer::block_download:
    case SdoAnswer::block_upload:
      return "part of a block transfer, beginning not seen";
    case SdoAnswer::reserved:
      break;
  }
  return "unknown command " + bytes_text(std::span{frame.data}.first(1));
}

}  // namespace takt
