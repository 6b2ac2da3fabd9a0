#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "eds_parser/table/bus_plan.hpp"
#include "master/core/event.hpp"

namespace takt {

// Texts for the records of the bus thread. These functions allocate, so only the front side may
// call them.

/// Explains a failed boot in several lines: the node, the step (n of m) and its purpose, the frame
/// that was sent, the frame that was received, the abort code and the status letter in words, what
/// the EDS says, and what the user can try.
std::string explain(const BusPlan& plan, std::size_t node_index, const BootFailure& failure);

/// Describes the error status of CiA 302-2 in words, for example "vendor id differs".
std::string_view letter_text(char letter) noexcept;

/// Names the subject of a message: "node 5 'shoulder'", or "bus 'lift'" for node 0.
std::string subject(const BusPlan& plan, std::uint8_t node);

/// Describes an event in one line; for boot_failed, returns the explanation of several lines.
std::string describe(const BusPlan& plan, const Event& event);

/// Returns the name of a kind of event: "boot_failed", "emcy" ...
std::string_view name(EventKind kind) noexcept;
/// Returns the name of an NMT state: "boot-up", "OPERATIONAL" ...
std::string_view name(NmtState state) noexcept;
/// Returns the name of a boot state: "ready", "lost" ...
std::string_view name(BootState state) noexcept;
/// Returns the name of an SDO fault: "timeout", "aborted by the device" ...
std::string_view name(SdoFault fault) noexcept;

}  // namespace takt
