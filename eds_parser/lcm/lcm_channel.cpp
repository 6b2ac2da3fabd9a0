#include "eds_parser/lcm/lcm_channel.hpp"

#include <algorithm>

namespace takt {
namespace {

constexpr std::size_t longest_channel = 63;

char channel_char(char c) noexcept {
  if (c >= 'a' && c <= 'z') return static_cast<char>(c - 'a' + 'A');
  const bool kept = (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
  return kept ? c : '_';
}

}  // namespace

std::string channel_name(std::string_view bus, std::string_view what) {
  const std::size_t room = longest_channel - 1 - std::min(what.size(), longest_channel - 1);
  std::string channel{bus.substr(0, room)};
  std::ranges::transform(channel, channel.begin(), channel_char);
  channel += '_';
  channel += what.substr(0, longest_channel - channel.size());
  return channel;
}

}  // namespace takt
