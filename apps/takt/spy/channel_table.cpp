#include "apps/takt/spy/channel_table.hpp"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>

#include "apps/takt/spy/message_types.hpp"
#include "eds_parser/values/ids.hpp"
#include "master/lcm/big_endian.hpp"

namespace takt::spy {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t widest_channel = 32;
/// A channel without a message for this time is shown as silent, in dim letters.
constexpr Time silence = 3s;

std::string age_text(Time age) {
  const double seconds = std::chrono::duration<double>(age).count();
  if (seconds < 1.0) return fmt::format("{:.0f} ms", seconds * 1000);
  return seconds < 1000 ? fmt::format("{:.1f} s", seconds)
                        : fmt::format("{:.0f} min", seconds / 60);
}

std::string rate_text(const ChannelState& state) {
  if (state.rate == 0.0) return "-";
  return state.rate < 10 ? fmt::format("{:.1f}", state.rate) : fmt::format("{:.0f}", state.rate);
}

std::string row(std::string_view channel, std::size_t width, const std::string& type,
                const std::string& rate, const std::string& age, const std::string& bytes) {
  return left(channel, width) + "  " + left(type, 18) + right(rate, 8) + right(age, 9) +
         right(bytes, 7);
}

}  // namespace

std::string type_text(std::string_view channel, std::uint64_t fingerprint) {
  const std::string_view own = own_type(fingerprint);
  if (!own.empty()) return std::string{own};
  if (channel.ends_with("_STATE")) return "state of a node";
  if (channel.ends_with("_COMMAND")) return "command of a node";
  return hex64(fingerprint);
}

void ChannelTable::take(std::string_view channel, Bytes data, Time now) {
  auto found = channels_.find(channel);
  if (found == channels_.end()) {
    if (channels_.size() == most_channels) {
      ++left_out_;
      return;
    }
    found = channels_.emplace(std::string{channel}, ChannelState{}).first;
  }
  ChannelState& state = found->second;
  state.fingerprint = data.size() < 8 ? 0 : load_be<std::uint64_t>(data);
  ++state.messages;
  ++state.recent;
  state.bytes = data.size();
  state.newest = now;
}

void ChannelTable::tick(Time now) {
  const Time window = now - window_begin_;
  if (window < 1s) return;
  for (auto& [channel, state] : channels_) {
    state.rate = static_cast<double>(state.recent) / std::chrono::duration<double>(window).count();
    state.recent = 0;
  }
  window_begin_ = now;
}

std::vector<Line> ChannelTable::lines(Time now) const {
  std::size_t width = 12;
  for (const auto& [channel, state] : channels_) width = std::max(width, channel.size());
  width = std::min(width, widest_channel);
  std::vector<Line> lines;
  lines.push_back(Line{}.add(row("CHANNEL", width, "TYPE", "1/s", "AGE", "BYTES"), Paint::title));
  for (const auto& [channel, state] : channels_) {
    const bool is_silent = now - state.newest > silence;
    lines.push_back(
        Line{}.add(row(channel, width, type_text(channel, state.fingerprint), rate_text(state),
                       age_text(now - state.newest), std::to_string(state.bytes)),
                   is_silent ? Paint::dim : Paint::plain));
  }
  if (left_out_ != 0) {
    lines.push_back(Line{}.add(fmt::format("and {} messages of further channels", left_out_)));
  }
  return lines;
}

}  // namespace takt::spy
