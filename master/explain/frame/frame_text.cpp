#include "master/explain/frame/frame_text.hpp"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>

#include "master/explain/frame/emergency_text.hpp"
#include "master/explain/frame/frame_value_text.hpp"
#include "master/explain/frame/lss_text.hpp"
#include "master/explain/frame/pdo_text.hpp"
#include "master/wire/nmt.hpp"
#include "master/wire/time_of_day.hpp"

namespace takt {
namespace {

std::string_view command_text(NmtCommand command) {
  switch (command) {
    case NmtCommand::start:
      return "start";
    case NmtCommand::stop:
      return "stop";
    case NmtCommand::enter_preoperational:
      return "enter pre-operational";
    case NmtCommand::reset_node:
      return "reset";
    case NmtCommand::reset_communication:
      return "reset communication";
  }
  return "unknown";
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
  switch (id) {
    case 0x071:
      return "the active master answers";
    case 0x072:
      return "negotiation: a master offers itself";
    case 0x073:
      return "which master is active?";
    case 0x074:
      return "a master answers that it is present";
    case 0x075:
      return "is there a master?";
    case 0x076:
      return "a new negotiation is forced";
    default:
      return {};
  }
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
