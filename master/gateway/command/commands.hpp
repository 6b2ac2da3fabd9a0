#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <takt/command_t.hpp>
#include <utility>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"
#include "master/core/command_limit.hpp"
#include "master/core/node_status.hpp"
#include "master/gateway/command/lease.hpp"
#include "master/gateway/notice/notice.hpp"
#include "master/lcm/rate_limit.hpp"

namespace takt {

/// Stages one output for the bus thread. If the time to live is output_released, the call releases
/// the output.
using SetOutput =
    std::function<void(SignalIndex signal, std::int64_t value, std::uint32_t time_to_live)>;

/// Reason for refusing a command.
enum class CommandRefusal : std::uint8_t {
  observing,
  schema,
  session,     ///< the command is for another run of taktd
  sender,      ///< the sender has no valid name, or instance 0
  no_cycle,    ///< the command does not name the cycle of its image
  future,      ///< the cycle of its image has not come yet
  bad_signal,  ///< a signal is not an output of the layout
  bad_value,   ///< a value does not fit the bits of its signal
  too_old,
  not_ready,  ///< the node has not booted, or is not operational
  held,       ///< another sender holds the node
  waited,     ///< the command waited while the front thread did not run
  overtaken,  ///< a command computed from a later cycle, or a release computed from the same cycle,
              ///< came before
};
inline constexpr std::size_t command_refusals = 13;
std::string_view name(CommandRefusal refusal) noexcept;  ///< "too_old"

struct CommandsOptions {
  std::int64_t session = 0;
  bool observe = false;
};

/// The state of the bus when a command arrives.
struct CommandContext {
  std::uint64_t cycle = 0;  ///< present cycle by the clock; 0 before the first image
  Time now{};
  std::span<const NodeStatus> nodes;  ///< states in the order of BusPlan::nodes
  /// The node of the typed channel; a release on it reaches only this node.
  std::optional<std::size_t> only_node{};
};

/// Turns command_t messages into set-points. A node takes either all or none of its values in a
/// message. Refusals are reported at most once per second for the same reason, sender and node. All
/// calls come from the front thread.
class Commands {
 public:
  Commands(const BusPlan& plan, CommandsOptions options, SetOutput set_output, NoticeSink announce);

  /// Takes a message. Returns true if at least one output was staged.
  bool take(const command_t& command, const CommandContext& context);

  /// Checks the session, the sender and the cycle of a message that is no command of outputs, such
  /// as a motion. A refusal is reported.
  bool admits(const command_t& header, const CommandContext& context);
  /// Returns true if the sender of a message that is no command of outputs can get these nodes: the
  /// message is not too old, and nobody else holds one of the nodes. A refusal is reported.
  bool admits_lease(const command_t& header, std::span<const std::size_t> nodes,
                    const CommandContext& context);
  /// Gives these nodes for `cycles` to the sender of the message, if admits_lease() permits it.
  bool lease(const command_t& header, std::span<const std::size_t> nodes, std::uint32_t cycles,
             const CommandContext& context);
  /// Gives the sender of a sign of life those of these nodes that it can get, and reports no
  /// refusal. A sign of life does not prevent a release by the same sender from taking effect.
  void renew(const command_t& header, std::span<const std::size_t> nodes, std::uint32_t cycles,
             const CommandContext& context);
  /// Returns true if a message that is no command of outputs may stop the axes of the node: it is
  /// not too old, and no other sender holds the node. The node need not be ready, and a later
  /// message may have overtaken this one. A refusal is reported.
  bool admits_stop(const command_t& header, std::size_t node, const CommandContext& context);
  /// Returns true if the sender with this instance holds the node.
  bool holds(std::size_t node, std::int64_t instance, std::uint64_t cycle) const noexcept {
    return leases_.holds(node, instance, cycle);
  }

  std::uint64_t taken() const noexcept { return taken_; }
  std::uint64_t refused() const noexcept {
    return std::accumulate(refused_.begin(), refused_.end(), std::uint64_t{0});
  }
  /// Returns the refused commands by reason, in the order of CommandRefusal.
  const std::array<std::uint64_t, command_refusals>& refusals() const noexcept { return refused_; }
  std::string_view holder(std::size_t node_index, std::uint64_t cycle) const noexcept {
    return leases_.holder(node_index, cycle);
  }
  std::string_view last_holder(std::size_t node_index) const noexcept {
    return leases_.last_holder(node_index);
  }
  /// Returns the limit of the newest accepted command to an output; std::nullopt before the first.
  std::optional<CommandLimit> newest_limit(std::int64_t signal) const noexcept;
  /// Counts a message that was not examined because it may have waited for long.
  void discard() noexcept { count(CommandRefusal::waited); }

 private:
  struct Item {
    SignalIndex signal = 0;
    std::int64_t value = 0;
    std::uint32_t cycles = 0;  ///< remaining cycles of its time to live; 0 means no limit
    CommandLimit limit{};
  };
  enum class Verdict : std::uint8_t { unknown, accepted, refused };

  /// A message and the state of the bus when it arrived.
  struct Received {
    const command_t& command;
    const CommandContext& context;
  };

  bool check_message(const Received& from);
  bool read_items(const Received& from);
  /// The reason why a sender does not get a node.
  struct Objection {
    CommandRefusal reason;
    std::string why;
  };
  std::optional<Objection> objection_to(std::size_t node_index, const Received& from) const;
  std::optional<Objection> objection_of_age(std::size_t node_index, const Received& from) const;
  bool refuse_node(std::size_t node_index, const Objection& objection, const Received& from);
  void take_node(std::size_t node_index, const LeaseTerm& term, const Received& from);
  bool check_node(std::size_t node_index, std::uint32_t cycles, const Received& from);
  bool check_cycle(const Received& from);
  std::string owned_text(std::size_t node_index, const Received& from) const;
  bool release(const Received& from);
  bool release_node(std::size_t node, const Received& from);
  Freshness freshness_of(const command_t& command, std::uint64_t now,
                         std::uint32_t configured) const noexcept;
  std::uint32_t shortest_limit(std::size_t node) const noexcept;
  std::uint32_t lease_cycles(std::size_t node_index) const noexcept;
  /// The reason why a command is refused, and the node that it concerns; 0 if it concerns no single
  /// node.
  struct Refused {
    CommandRefusal reason;
    std::uint8_t node = 0;
  };
  bool refuse(const Received& from, const Refused& refused, const std::string& why);
  void count(CommandRefusal reason) noexcept { ++refused_[std::to_underlying(reason)]; }

  const BusPlan& plan_;
  CommandsOptions options_;
  SetOutput set_output_;
  NoticeSink announce_;
  std::uint32_t second_;  // cycles in one second
  LeaseTable leases_;
  RateLimit reported_{std::chrono::seconds{1}};
  std::vector<Item> items_;        // items of the current message
  std::vector<Verdict> verdicts_;  // per node, for the current message
  // Limit of the newest command, indexed by signal.
  std::vector<std::optional<CommandLimit>> limits_;
  std::uint64_t taken_ = 0;
  std::array<std::uint64_t, command_refusals> refused_{};
};

}  // namespace takt
