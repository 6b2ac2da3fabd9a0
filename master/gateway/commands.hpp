#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <takt/command_t.hpp>
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
  std::uint64_t refused() const noexcept { return refused_; }
  std::string_view holder(std::size_t node_index, std::uint64_t cycle) const noexcept {
    return leases_.holder(node_index, cycle);
  }
  std::string_view last_holder(std::size_t node_index) const noexcept {
    return leases_.last_holder(node_index);
  }
  /// A message that was not looked at, since it may have waited for long.
  void discard() noexcept { ++refused_; }

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
  bool refuse(const CommandContext& context, const command_t& command, std::uint8_t node,
              const std::string& why);

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
  std::uint64_t refused_ = 0;
};

}  // namespace takt
