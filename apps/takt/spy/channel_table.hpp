#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "apps/takt/live/screen.hpp"
#include "eds_parser/table/time.hpp"
#include "master/lcm/messages.hpp"

namespace takt::spy {

/// What is known of one channel.
struct ChannelState {
  std::uint64_t fingerprint = 0;
  std::uint64_t messages = 0;
  std::uint64_t recent = 0;  ///< in the window that the rate counts
  double rate = 0.0;         ///< messages a second in the last window; 0 before
  std::size_t bytes = 0;     ///< of the newest message
  Time newest{};             ///< its arrival, monotonic
};

/// All channels from which messages have come, with their rates.
class ChannelTable {
 public:
  static constexpr std::size_t most_channels = 1000;

  /// Begins at `now` (monotonic).
  explicit ChannelTable(Time now) : window_begin_{now} {}

  void take(std::string_view channel, Bytes data, Time now);
  /// Counts the rates; call it often. A window is at least a second long.
  void tick(Time now);

  const std::map<std::string, ChannelState, std::less<>>& channels() const noexcept {
    return channels_;
  }

  /// Returns the table for a terminal: channel, type, rate, age and size, at most 80 columns as
  /// long as the names of the channels are not longer than 32.
  std::vector<Line> lines(Time now) const;

 private:
  std::map<std::string, ChannelState, std::less<>> channels_;
  std::uint64_t left_out_ = 0;  // messages of further channels
  Time window_begin_;
};

/// Returns the name of a type of takt, what a channel name says of a type of `takt export lcm`, or
/// the fingerprint in hex.
std::string type_text(std::string_view channel, std::uint64_t fingerprint);

}  // namespace takt::spy
