#include "apps/move/stop_reasons.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <fmt/format.h>
#include <string_view>

namespace takt {
namespace {

constexpr std::size_t most_reasons = 64;
/// The beginnings of the causes that count as pauses, as the events of taktd state them: a sender
/// that was silent, missing SYNCs, and cycles in which the set-points were not sent.
constexpr std::array<std::string_view, 3> pauses{"its sender was silent", "SYNC was missing",
                                                 "its set-points were not sent"};

/// Returns the part of the text before the name of the axis that has caused the stop.
std::string begin_of_reason(std::int32_t id) {
  return fmt::format("motion {} has stopped because of ", id);
}

/// Returns true if the cause, which follows the name of an axis, is one of the pauses.
bool is_pause(std::string_view text, std::string_view begin) {
  std::string_view cause = text.substr(text.find(begin) + begin.size());
  const std::size_t colon = cause.find(": ");
  if (colon == std::string_view::npos) return false;
  cause.remove_prefix(colon + 2);
  return std::ranges::any_of(
      pauses, [&](std::string_view of_pause) { return cause.starts_with(of_pause); });
}

}  // namespace

void StopReasons::take(const event_t& event) {
  if (event.kind != "motion_stopped") return;
  if (texts_.size() == most_reasons) texts_.pop_front();
  texts_.push_back(event.text);
}

std::string StopReasons::of(std::int32_t id) const {
  const std::string begin = begin_of_reason(id);
  std::string found;
  for (const std::string& text : texts_) {
    if (!text.contains(begin)) continue;
    if (!is_pause(text, begin)) return text;
    if (found.empty()) found = text;
  }
  return found;
}

bool StopReasons::only_paused(std::int32_t id) const {
  const std::string text = of(id);
  return !text.empty() && is_pause(text, begin_of_reason(id));
}

}  // namespace takt
