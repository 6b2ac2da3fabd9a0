#include "master/lcm/channel_names.hpp"

namespace takt {

std::string_view bus_of_channel(std::string_view channel, std::string_view what) noexcept {
  if (channel.size() < what.size() + 2 || !channel.ends_with(what)) return {};
  channel.remove_suffix(what.size());
  if (channel.back() != '_') return {};
  channel.remove_suffix(1);
  return channel;
}

std::string any_bus(std::string_view what) { return ".+_" + std::string{what}; }

}  // namespace takt
