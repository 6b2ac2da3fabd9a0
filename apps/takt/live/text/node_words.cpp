#include "apps/takt/live/text/node_words.hpp"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>

#include "master/core/node_status.hpp"
#include "master/explain/boot_report.hpp"

namespace takt {
namespace {

Paint boot_paint(int state) {
  using enum BootState;
  const auto boot = static_cast<BootState>(state);
  if (boot == failed || boot == lost) return Paint::bad;
  if (boot == ready) return Paint::good;
  return boot == booting ? Paint::warning : Paint::dim;
}

}  // namespace

std::string nmt_name(int state) {
  std::string text{name(static_cast<NmtState>(state))};
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::string boot_name(const node_status_t& node) {
  const auto state = static_cast<BootState>(node.boot_state);
  if (state == BootState::booting) {
    return fmt::format("step {} of {}", node.boot_step + 1, node.boot_steps);
  }
  return state == BootState::failed ? "boot failed" : std::string{name(state)};
}

std::string stop_name(int stop) {
  static constexpr const char* names[] = {"none", "under way", "confirmed", "not confirmed"};
  return names[std::clamp(stop, 0, 3)];
}

std::string bus_condition(int state) {
  static constexpr const char* conditions[] = {"running", "starting", "offline", "stopped"};
  return conditions[std::clamp(state, 0, 3)];
}

PaintedText nmt_text(int state) {
  const bool known = state != static_cast<int>(NmtState::unknown);
  const bool good = state == static_cast<int>(NmtState::operational);
  return {nmt_name(state), good ? Paint::good : known ? Paint::warning : Paint::dim};
}

PaintedText boot_text(const node_status_t& node) {
  const bool boots = node.boot_state == static_cast<int>(BootState::booting);
  return {boots ? fmt::format("boot {}/{}", node.boot_step + 1, node.boot_steps) : boot_name(node),
          boot_paint(node.boot_state)};
}

}  // namespace takt
