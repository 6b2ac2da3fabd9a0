#include "master/explain/frame/frame_text.hpp"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>

#include "master/explain/frame/frame_value_text.hpp"
#include "master/explain/frame/service_texts.hpp"
#include "master/wire/nmt.hpp"
#include "master/wire/time_of_day.hpp"

namespace takt {
namespace {

std::string_view command_text(NmtCommand command) {
  using enum NmtCommand;
  constexpr std::pair<NmtCommand, std::string_view> texts[] = {
      {start, "start"},
      {stop, "stop"},
      {enter_preoperational, "enter pre-operational"},
      {reset_node, "reset"},
      {reset_communication, "reset communication"}};
  const auto found = std::ranges::find(texts, command, [](const auto& row) { return row.first; });
  return found == std::end(texts) ? "unknown" : found->second;
}

/// Describes TIME_OF_DAY: milliseconds since midnight (28 bits) and days since 1984-01-01. CiA 301,
/// 7.1.6.6.
std::string time_text(const Frame& frame) {
  const auto time = decode_time(frame);
  if (!time) return fmt::format("has {} bytes instead of 6", frame.length);
  const std::chrono::sys_days day{std::chrono::days{unix_time(*time) / std::chrono::days{1}}};
  const std::chrono::year_month_day date{day};
  const std::string clock =
      fmt::format("{:02}:{:02}:{:02}.{:03}", time->ms / 3'600'000, time->ms / 60'000 % 60,
                  time->ms / 1000 % 60, time->ms % 1000);
  if (time->ms >= 86'400'000) return fmt::format("day {} since 1984, {}", time->days, clock);
  return fmt::format("{:04}-{:02}-{:02} {}, day {} since 1984", int{date.year()},
                     unsigned{date.month()}, unsigned{date.day()}, clock, time->days);
}

/// Describes the frames with which several masters agree on the active one. CiA 302-2, flying
/// master.
std::string_view master_text(std::uint32_t id) {
  constexpr std::uint32_t first = 0x071;
  constexpr std::string_view texts[] = {
      "the active master answers", "negotiation: a master offers itself",
      "which master is active?",   "a master answers that it is present",
      "is there a master?",        "a new negotiation is forced"};
  return id - first < std::size(texts) ? texts[id - first] : std::string_view{};
}

}  // namespace

FrameMeaning FrameText::nmt(const Frame& frame) const {
  Frame command = frame;
  command.length = std::min<std::uint8_t>(frame.length, 2);
  const auto message = decode_nmt(command);
  if (!message) return {.service = "NMT", .text = "not a command: " + bytes_text(frame.payload())};
  const std::string who = message->node == 0 ? "all nodes" : names_.node(message->node);
  std::string text = fmt::format("{} {}", command_text(message->command), who);
  if (frame.length > 2) text += fmt::format(" ({} bytes instead of 2)", frame.length);
  return {.service = "NMT", .node = message->node, .text = std::move(text)};
}

FrameMeaning FrameText::sync(const Frame& frame) const {
  std::string text = frame.length == 0 ? "" : fmt::format("{}", frame.data[0]);
  if (frame.rtr) text = "remote request";
  if (frame.length > 1) text += fmt::format(" ({} bytes instead of at most 1)", frame.length);
  return {.service = "SYNC", .text = std::move(text)};
}

/// Describes frames that concern all nodes or no node in particular.
std::optional<FrameMeaning> FrameText::broadcast(const Frame& frame) const {
  const BusPlan* plan = names_.plan();
  const CobId sync_id = plan == nullptr ? CobId::base(0x080) : plan->cycle.sync_cob_id;
  const CobId time_id = plan == nullptr ? TimePlan{}.cob_id : plan->time.cob_id;
  if (frame.id == sync_id) return sync(frame);
  if (frame.id == time_id) return FrameMeaning{.service = "TIME", .text = time_text(frame)};
  if (frame.id.is_extended()) return {};
  const std::uint32_t id = frame.id.id();
  if (id == 0x000) return nmt(frame);
  if (id == 0x001) return FrameMeaning{.service = "GFC", .text = "global fail-safe command"};
  if (id == 0x7E4 || id == 0x7E5) {
    return FrameMeaning{.service = "LSS", .text = lss_text(frame, id == 0x7E5)};
  }
  const std::string_view master = master_text(id);
  if (master.empty()) return {};
  const char* gap = frame.length == 0 ? "" : ": ";
  return FrameMeaning{.service = "MASTER",
                      .text = fmt::format("{}{}{}", master, gap, bytes_text(frame.payload()))};
}

FrameMeaning FrameText::meaning(const Frame& frame) {
  if (auto mapped = planned_pdo(names_, frame)) return std::move(*mapped);
  if (auto reported = broadcast(frame)) return std::move(*reported);
  if (auto reported = sdo_.meaning(frame)) return std::move(*reported);
  if (const auto sender = names_.emcy_sender(frame.id)) {
    return emergency_meaning(names_, *sender, frame);
  }
  const std::uint32_t id = frame.id.id();
  const unsigned node = id & 0x7F;
  if (frame.id.is_extended() || node == 0) return {};
  if ((id & ~0x7FU) == 0x700) return error_control_.meaning(node, names_.node(node), frame);
  if (id >= 0x180 && id < 0x580) return predefined_pdo(names_, frame);
  return {};
}

}  // namespace takt
