#pragma once
#include <expected>
#include <string_view>
#include <variant>

#include "master/linux/can/socket_can.hpp"
#include "master/linux/unix_bus/unix_bus.hpp"

namespace takt {

using AnyPort = std::variant<SocketCanPort, UnixBusPort>;

/// Opens the bus for the bus thread: `can0` with the filters and the SYNC of the plan, or
/// `unix:PATH`. `sent` counts the sent frames for a DiagnosticSocket.
std::expected<AnyPort, BusError> open_bus(std::string_view bus, const BusPlan& plan, Time spin,
                                          SentFrames* sent = nullptr);

}  // namespace takt
