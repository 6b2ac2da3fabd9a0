#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "eds_parser/table/bus_plan.hpp"
#include "master/core/event.hpp"

namespace takt {

// Records of the bus thread in words. Front side: everything here allocates.

/// The whole story of a failed boot in several lines: which node, step n of m and its purpose, what
/// was sent, what came back, abort code and status letter in words, what the EDS says, what to try.
std::string explain(const BusPlan& plan, std::size_t node_index, const BootFailure& failure);

/// What to try against a failed boot, made for its cause.
std::string remedy(const BusPlan& plan, const NodePlan& node, const BootFailure& failure);

/// Error status of CiA 302-2 in words: "vendor id differs".
std::string_view letter_text(char letter) noexcept;

/// "node 5 'shoulder'"; 0: "bus 'lift'".
std::string subject(const BusPlan& plan, std::uint8_t node);

/// One line for any event; the explanation for boot_failed.
std::string describe(const BusPlan& plan, const Event& event);

/// "boot_failed", "emcy" ...
std::string_view name(EventKind kind) noexcept;
/// "boot-up", "OPERATIONAL" ...
std::string_view name(NmtState state) noexcept;
/// "ready", "lost" ...
std::string_view name(BootState state) noexcept;
/// "timeout", "aborted by the device" ...
std::string_view name(SdoFault fault) noexcept;

}  // namespace takt
