#include "apps/frame_text/sdo_text.hpp"

#include <fmt/format.h>

#include "apps/frame_text/value_text.hpp"
#include "master/wire/sdo_abort.hpp"
#include "master/wire/sdo_codec.hpp"

namespace takt {
namespace {

constexpr std::size_t most_kept = 4096;  // bytes of one value

}  // namespace

void SdoText::keep(Transfer& transfer, std::span<const std::uint8_t> bytes) {
  if (transfer.value.size() + bytes.size() > most_kept) {
    transfer.truncated = true;
    return;
  }
  transfer.value.insert(transfer.value.end(), bytes.begin(), bytes.end());
}

std::string SdoText::object(unsigned node, const Transfer& transfer) const {
  return names_->object(node, transfer.object);
}

/// The frame with the object and, expedited, with its value.
std::string SdoText::initiate(unsigned node, Transfer& transfer, const Frame& frame,
                              const char* verb) {
  const SdoInitiate begin = decode_initiate(frame);
  transfer = {.object = begin.object, .open = !begin.expedited, .value = {}};
  if (begin.expedited) {
    return fmt::format("{} {} = {}", verb, object(node, transfer),
                       value_text(names_->type(node, begin.object), begin.payload()));
  }
  const std::string size = begin.size ? fmt::format("{} bytes", *begin.size) : "of unknown size";
  return fmt::format("{} {}, {} in segments", verb, object(node, transfer), size);
}

std::string SdoText::segment(unsigned node, Transfer& transfer, const Frame& frame,
                             const char* verb) {
  const SdoSegment part = decode_segment(frame);
  if (!transfer.open) return fmt::format("segment of {} bytes, beginning not seen", part.size);
  keep(transfer, part.payload());
  std::string text = fmt::format("segment of {}, {} bytes", object(node, transfer), part.size);
  if (!part.last) return text;
  transfer.open = false;
  if (transfer.truncated) return text + ", the last";
  return fmt::format("{} {} = {} (last segment)", verb, object(node, transfer),
                     value_text(names_->type(node, transfer.object), transfer.value));
}

std::string SdoText::abort(unsigned node, Transfer& transfer, const Frame& frame) {
  transfer = {.object = sdo_object(frame), .value = {}};
  const std::uint32_t code = sdo_abort_code(frame);
  return fmt::format("ABORT {}: {:04X} {:04X} {}", object(node, transfer), code >> 16,
                     code & 0xFFFF, abort_text(code));
}

std::string SdoText::block_segment(unsigned node, Transfer& transfer, const Frame& frame) {
  const unsigned number = frame.data[0] & 0x7F;
  const bool last = (frame.data[0] & 0x80) != 0;
  return fmt::format("block segment {} of {}{}", number, object(node, transfer),
                     last ? ", the last" : "");
}

std::string SdoText::block_request(unsigned node, Transfer& transfer, const Frame& frame) {
  const unsigned command = frame.data[0] >> 5;
  const unsigned sub_command = frame.data[0] & 3;
  if (command == 6) {  // block download: 0 initiate, 1 end
    if ((sub_command & 1) != 0) {
      transfer.block = false;
      return fmt::format("end of block download {}", object(node, transfer));
    }
    transfer = {.object = sdo_object(frame), .block = true, .value = {}};
    return fmt::format("block download {}", object(node, transfer));
  }
  switch (sub_command) {  // block upload: 0 initiate, 1 end, 2 answer, 3 start
    case 0:
      transfer = {.object = sdo_object(frame), .block = true, .upload = true, .value = {}};
      return fmt::format("block upload {}", object(node, transfer));
    case 1:
      transfer.block = false;
      return fmt::format("end of block upload {}", object(node, transfer));
    case 2:
      return fmt::format("block upload: {} segments taken", frame.data[1]);
    default:
      return "block upload: go on";
  }
}

std::string SdoText::block_answer(unsigned node, Transfer& transfer, const Frame& frame) {
  const unsigned sub_command = frame.data[0] & 3;
  if (frame.data[0] >> 5 == 6) {  // block upload: 0 initiate, 1 end
    const char* what = sub_command == 1 ? "all sent" : "accepted";
    return fmt::format("block upload {} {}", object(node, transfer), what);
  }
  switch (sub_command) {  // block download: 0 initiate, 1 end, 2 answer
    case 0:
      return fmt::format("block download {} accepted, {} segments a block", object(node, transfer),
                         frame.data[4]);
    case 2:
      return fmt::format("block download: {} segments taken", frame.data[1]);
    default:
      return fmt::format("block download {} done", object(node, transfer));
  }
}

std::string SdoText::request(unsigned node, const Frame& frame) {
  Transfer& transfer = transfers_[node & 0x7F];
  if (frame.length != 8) return fmt::format("of {} bytes (always 8)", frame.length);
  const SdoRequest command = sdo_request(frame);
  if (transfer.block && !transfer.upload && command != SdoRequest::block_download &&
      frame.data[0] != 0x80) {
    return block_segment(node, transfer, frame);
  }
  switch (command) {
    case SdoRequest::download_segment:
      return segment(node, transfer, frame, "write");
    case SdoRequest::download_initiate:
      return initiate(node, transfer, frame, "write");
    case SdoRequest::upload_initiate:
      transfer = {.object = sdo_object(frame), .upload = true, .value = {}};
      return fmt::format("read {}", object(node, transfer));
    case SdoRequest::upload_segment:
      return fmt::format("next segment of {}", object(node, transfer));
    case SdoRequest::abort:
      return abort(node, transfer, frame);
    case SdoRequest::block_upload:
    case SdoRequest::block_download:
      return block_request(node, transfer, frame);
    case SdoRequest::reserved:
      break;
  }
  return "unknown command " + bytes_text(std::span{frame.data}.first(1));
}

std::string SdoText::answer(unsigned node, const Frame& frame) {
  Transfer& transfer = transfers_[node & 0x7F];
  if (frame.length != 8) return fmt::format("of {} bytes (always 8)", frame.length);
  const SdoAnswer command = sdo_answer(frame);
  if (transfer.block && transfer.upload && command != SdoAnswer::block_upload &&
      frame.data[0] != 0x80) {
    return block_segment(node, transfer, frame);
  }
  switch (command) {
    case SdoAnswer::upload_segment:
      return segment(node, transfer, frame, "read");
    case SdoAnswer::download_segment:
      return "segment taken";
    case SdoAnswer::upload_initiate:
      return initiate(node, transfer, frame, "read");
    case SdoAnswer::download_initiate:
      return fmt::format("written {}", names_->object(node, sdo_object(frame)));
    case SdoAnswer::abort:
      return abort(node, transfer, frame);
    case SdoAnswer::block_download:
    case SdoAnswer::block_upload:
      return block_answer(node, transfer, frame);
    case SdoAnswer::reserved:
      break;
  }
  return "unknown command " + bytes_text(std::span{frame.data}.first(1));
}

}  // namespace takt
