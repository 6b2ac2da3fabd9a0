#pragma once
#include <string>
#include <string_view>

#include "eds_parser/lcm/lcm_channel.hpp"

namespace takt {

/// Returns the bus part of a channel name that ends in `_what`; empty if the name does not.
std::string_view bus_of_channel(std::string_view channel, std::string_view what) noexcept;

/// Returns a pattern for LCM subscriptions that matches this channel of any bus.
std::string any_bus(std::string_view what);

}  // namespace takt
