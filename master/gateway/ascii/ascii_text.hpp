#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "master/core/event.hpp"
#include "master/core/lss/lss_command.hpp"
#include "master/core/request.hpp"
#include "master/gateway/ascii/ascii_command.hpp"

// Formats the lines of CiA 309-3 that go to clients.

namespace takt::ascii {

/// Returns `[seq] ERROR: code (why)`.
std::string error_line(std::uint32_t sequence, AsciiError error, std::string_view why);
std::string abort_line(std::uint32_t sequence, std::uint32_t code);
/// Returns the error code for a reply that failed and has no abort code.
AsciiError error_of(const Reply& reply);

std::vector<LssResult> lss_results(const Reply& reply);
std::string address_text(const LssResult& result);
/// Returns the answer to an LSS service that succeeded.
std::string lss_answer(const AsciiCommand& command, const Reply& reply);

// Returns the texts of events for clients; empty if clients are not informed of the event.
std::string node_event(const Event& event);
std::string bus_event(EventKind kind);
bool is_bootup(const Event& event) noexcept;

}  // namespace takt::ascii
