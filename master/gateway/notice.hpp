#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <takt/event_t.hpp>

#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/table/time.hpp"
#include "master/core/event.hpp"

namespace takt {

/// Weight of an event, as event_t codes it.
enum class Weight : std::int16_t { note = 0, warning = 1, error = 2 };

/// One thing to tell: on stderr, in the event file, on LCM. Made by the bus thread (an Event) or by
/// the gateway itself.
struct Notice {
  Time when{};  ///< monotonic
  std::uint64_t cycle = 0;
  std::uint8_t node = 0;  ///< 0: the bus
  std::string kind;       ///< "boot_failed"
  Weight weight = Weight::note;
  std::string text;
  /// boot_failed: the next try of this boot asks the node in another way, so it isn't missing yet.
  bool asks_on = false;
};

using NoticeSink = std::function<void(const Notice&)>;

Weight weight_of(EventKind kind) noexcept;
std::string_view name(Weight weight) noexcept;  ///< "note", "warning", "error"

/// The event in words.
Notice to_notice(const BusPlan& plan, const Event& event);

/// `utime` and `session` are left to the caller. The text is cut where the message would grow
/// beyond one datagram.
event_t to_message(const BusPlan& plan, const Notice& notice);

/// "shoulder"; empty for the bus and for nodes that the plan does not have.
std::string_view node_name(const BusPlan& plan, std::uint8_t node) noexcept;

}  // namespace takt
