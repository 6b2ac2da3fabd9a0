#pragma once
#include <string>
#include <string_view>

#include "eds_parser/lcm/lcm_channel.hpp"

namespace takt {

/// Returns the bus part of a channel name that ends in `_what`; empty if the name has another end.
inline std::string_view bus_of_channel(std::string_view channel, std::string_view what) noexcept {
  if (channel.size() < what.size() + 2 || !channel.ends_with(what)) return {};
  channel.remove_suffix(what.size());
  if (channel.back() != '_') return {};
  channel.remove_suffix(1);
  return channel;
}

/// Returns a pattern for LCM subscriptions that matches this channel of any bus.
inline std::string any_bus(std::string_view what) { return ".+_" + std::string{what}; }

}  // namespace takt
