#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <numeric>
#include <span>
#include <string>
#include <string_view>
#include <takt/command_t.hpp>
#include <utility>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"
#include "master/core/node_status.hpp"
#include "master/gateway/lease.hpp"
#include "master/gateway/notice.hpp"
#include "master/gateway/rate_limit.hpp"

namespace takt {

/// Stages one output for the bus thread. A time to live of output_released gives it up.
using SetOutput =
    std::function<void(SignalIndex signal, std::int64_t value, std::uint32_t time_to_live)>;

/// Why a command is refused.
enum class CommandRefusal : std::uint8_t {
  observing,
  schema,
  session,     ///< of another run of taktd
  sender,      ///< its name, or instance 0
  no_cycle,    ///< it names no cycle that it was computed from
  future,      ///< it was computed from a cycle that has not come yet
  bad_signal,  ///< no output of the layout
  bad_value,   ///< it does not fit the bits of its signal
  too_old,
  not_ready,  ///< the node has not booted, or is not operational
  held,       ///< by another sender
  waited,     ///< while the front thread stood still
};
inline constexpr std::size_t command_refusals = 12;
std::string_view name(CommandRefusal refusal) noexcept;  ///< "too_old"

struct CommandsOptions {
  std::int64_t session = 0;
  bool observe = false;
};

/// What is known when a command arrives.
struct CommandContext {
  std::uint64_t cycle = 0;  ///< of this moment, by the clock; 0: no image so far
  Time now{};
  std::span<const NodeStatus> nodes;  ///< order of BusPlan::nodes
};

/// command_t -> set-points. A message counts for a node as a whole or not at all. What is refused
/// is told, at most once a second for the same reason, sender and node. Front thread.
class Commands {
 public:
  Commands(const BusPlan& plan, CommandsOptions options, SetOutput set_output, NoticeSink tell);

  /// True: at least one output was staged.
  bool take(const command_t& command, const CommandContext& context);

  std::uint64_t taken() const noexcept { return taken_; }
  std::uint64_t refused() const noexcept {
    return std::accumulate(refused_.begin(), refused_.end(), std::uint64_t{0});
  }
  /// By reason, in the order of CommandRefusal.
  const std::array<std::uint64_t, command_refusals>& refusals() const noexcept { return refused_; }
  std::string_view holder(std::size_t node_index, std::uint64_t cycle) const noexcept {
    return leases_.holder(node_index, cycle);
  }
  std::string_view last_holder(std::size_t node_index) const noexcept {
    return leases_.last_holder(node_index);
  }
  /// A message that was not looked at, since it may have waited for long.
  void discard() noexcept { count(CommandRefusal::waited); }

 private:
  struct Item {
    SignalIndex signal = 0;
    std::int64_t value = 0;
    std::uint32_t cycles = 0;  ///< left of its time to live
  };
  enum class Verdict : std::uint8_t { unknown, accepted, refused };

  bool check_message(const command_t& command, const CommandContext& context);
  bool read_items(const command_t& command, const CommandContext& context);
  bool check_node(std::size_t node_index, const command_t& command, const CommandContext& context);
  bool check_cycle(const command_t& command, const CommandContext& context);
  std::string owned_text(std::size_t node_index, const command_t& command,
                         const CommandContext& context) const;
  bool release(const command_t& command, const CommandContext& context);
  std::uint32_t lease_cycles(std::size_t node_index) const noexcept;
  /// What is refused, and in whose name.
  struct Refused {
    const CommandContext& context;
    const command_t& command;
    CommandRefusal reason;
    std::uint8_t node = 0;
  };
  bool refuse(const Refused& refused, const std::string& why);
  void count(CommandRefusal reason) noexcept { ++refused_[std::to_underlying(reason)]; }

  const BusPlan& plan_;
  CommandsOptions options_;
  SetOutput set_output_;
  NoticeSink tell_;
  std::uint32_t second_;  // in cycles
  LeaseTable leases_;
  RateLimit told_{std::chrono::seconds{1}};
  std::vector<Item> items_;        // of the message in hand
  std::vector<Verdict> verdicts_;  // per node, of the message in hand
  std::uint64_t taken_ = 0;
  std::array<std::uint64_t, command_refusals> refused_{};
};

}  // namespace takt
