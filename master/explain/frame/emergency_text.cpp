#include <array>
#include <fmt/format.h>

#include "master/explain/emcy_text.hpp"
#include "master/explain/frame/frame_value_text.hpp"
#include "master/explain/frame/service_texts.hpp"
#include "master/wire/emcy.hpp"

namespace takt {
namespace {

std::string code_text(const FrameNames& names, const Emcy& emcy) {
  if (emcy.code == 0 && emcy.error_register != 0) return "one error is reset, others remain";
  return std::string{names.emcy(emcy.node.value(), emcy.code)};
}

std::string text_of(const FrameNames& names, const Emcy& emcy, const Frame& frame) {
  const std::string who = names.node(emcy.node.value());
  if (frame.rtr) return who + " remote request";
  if (frame.length == 0) return who + " empty (the boot-up message of devices before CiA 301)";
  if (frame.length == 1) {
    return fmt::format("{} has 1 byte instead of 8, too short for an error code: {}", who,
                       bytes_text(frame.payload()));
  }
  std::string text = fmt::format("{} {:04X} {}, error register {:02X} ({})", who, emcy.code,
                                 code_text(names, emcy), emcy.error_register,
                                 error_register_text(emcy.error_register));
  const bool vendor = emcy.manufacturer != std::array<std::uint8_t, 5>{};
  if (vendor) text += ", vendor " + bytes_text(emcy.manufacturer);
  if (frame.length != 8) text += fmt::format(" ({} bytes instead of 8)", frame.length);
  return text;
}

}  // namespace

FrameMeaning emergency_meaning(const FrameNames& names, NodeId node, const Frame& frame) {
  return {
      .service = "EMCY", .node = node.value(), .text = text_of(names, emcy_of(node, frame), frame)};
}

}  // namespace takt
