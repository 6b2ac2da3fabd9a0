#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <takt/event_t.hpp>

#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/values/time.hpp"
#include "master/core/event.hpp"
#include "master/lcm/weight.hpp"

namespace takt {

/// One message for stderr, the event file and LCM. It comes from the bus thread (an Event) or from
/// the gateway itself.
struct Notice {
  Time when{};  ///< monotonic
  std::uint64_t cycle = 0;
  std::uint8_t node = 0;  ///< 0 means the bus
  std::string kind;       ///< "boot_failed"
  Weight weight = Weight::note;
  std::string text;
  /// Only for boot_failed: the next boot probes the node in another way, so the node does not count
  /// as missing yet.
  bool asks_on = false;
};

using NoticeSink = std::function<void(const Notice&)>;

Weight weight_of(EventKind kind) noexcept;

/// Describes the event in words.
Notice to_notice(const BusPlan& plan, const Event& event);

/// The caller sets `utime` and `session`. A text that would make the message longer than one
/// datagram is cut.
event_t to_message(const BusPlan& plan, const Notice& notice);

/// Returns the name of the node, such as "shoulder"; empty for the bus and for nodes outside the
/// plan.
std::string_view node_name(const BusPlan& plan, std::uint8_t node) noexcept;

}  // namespace takt
