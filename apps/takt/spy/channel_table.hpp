#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "apps/takt/live/screen.hpp"
#include "eds_parser/values/time.hpp"
#include "master/lcm/messages.hpp"

namespace takt::spy {

/// The state of one channel.
struct ChannelState {
  std::uint64_t fingerprint = 0;
  std::uint64_t messages = 0;
  std::uint64_t recent = 0;  ///< number of messages in the current window of the rate
  double rate = 0.0;         ///< messages a second in the last complete window; 0 before its end
  std::size_t bytes = 0;     ///< size of the newest message
  Time newest{};             ///< arrival of the newest message, monotonic
};

/// All channels from which messages have come, with their rates.
class ChannelTable {
 public:
  static constexpr std::size_t most_channels = 1000;

  /// The first window of the rate begins at `now` (monotonic).
  explicit ChannelTable(Time now) : window_begin_{now} {}

  void take(std::string_view channel, Bytes data, Time now);
  /// Updates the rates when a window has ended. A window is at least a second long, so call this
  /// more often.
  void tick(Time now);

  const std::map<std::string, ChannelState, std::less<>>& channels() const noexcept {
    return channels_;
  }

  /// Returns the table for a terminal: channel, type, rate, age and size. The lines have at most 80
  /// columns if no channel name has more than 32.
  std::vector<Line> lines(Time now) const;

 private:
  std::map<std::string, ChannelState, std::less<>> channels_;
  std::uint64_t left_out_ = 0;  // number of messages on channels that are not in the table
  Time window_begin_;
};

/// Returns the type of the messages: the name of a type of takt, the type of `takt export lcm` that
/// the channel name implies, or the fingerprint in hex.
std::string type_text(std::string_view channel, std::uint64_t fingerprint);

}  // namespace takt::spy
