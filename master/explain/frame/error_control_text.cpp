#include "master/explain/frame/error_control_text.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <utility>

namespace takt {
namespace {

std::string state_text(unsigned state) {
  constexpr std::pair<unsigned, std::string_view> states[] = {
      {0, "boot-up"}, {4, "stopped"}, {5, "operational"}, {127, "pre-operational"}};
  const auto found = std::ranges::find(states, state, [](const auto& row) { return row.first; });
  if (found != std::end(states)) return std::string{found->second};
  return fmt::format("unknown state 0x{:02X}", state);
}

}  // namespace

FrameMeaning ErrorControlText::request(unsigned node, const std::string& name) {
  Guarding& guarding = nodes_[node & 0x7F];
  const char* before = guarding.asked ? " again, the last answer is missing" : "";
  guarding.asked = true;
  return {.service = "GUARD",
          .node = node,
          .text = fmt::format("{} is asked for its state{}", name, before)};
}

FrameMeaning ErrorControlText::answer(unsigned node, const std::string& name, std::uint8_t byte) {
  Guarding& guarding = nodes_[node & 0x7F];
  const bool toggle = (byte & 0x80) != 0;
  const bool repeated = guarding.toggle == toggle;
  guarding = {.asked = false, .toggle = toggle};
  return {.service = "GUARD",
          .node = node,
          .text = fmt::format("{} answers: {}, toggle {}{}", name, state_text(byte & 0x7F),
                              toggle ? 1 : 0,
                              repeated ? " as before: the toggle bit should have changed" : "")};
}

FrameMeaning ErrorControlText::meaning(unsigned node, const std::string& name, const Frame& frame) {
  if (frame.rtr) return request(node, name);
  if (frame.length != 1) {
    return {.service = "HEARTBEAT",
            .node = node,
            .text = fmt::format("{} has {} bytes instead of 1", name, frame.length)};
  }
  Guarding& guarding = nodes_[node & 0x7F];
  if (frame.data[0] == 0) {
    guarding = {.asked = false, .toggle = true};  // the first answer has toggle bit 0
    return {.service = "BOOTUP", .node = node, .text = name};
  }
  if (guarding.asked) return answer(node, name, frame.data[0]);
  const bool toggle = (frame.data[0] & 0x80) != 0;
  return {.service = "HEARTBEAT",
          .node = node,
          .text = fmt::format("{} {}{}", name, state_text(frame.data[0] & 0x7F),
                              toggle ? ", toggle 1 (guarding; the request was not recorded)" : "")};
}

}  // namespace takt
