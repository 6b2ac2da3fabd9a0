#pragma once
#include <cstddef>
#include <vector>

#include "apps/takt/soak/evidence/verdict.hpp"
#include "eds_parser/table/bus_plan.hpp"

namespace takt::soak {

/// A set of senders of commands: one bit for each program.
using SenderBit = std::uint32_t;

/// Determines from the frames on the wire which sender holds each node, and checks that no sender
/// moves a node that another one holds.
class HolderJudge {
 public:
  /// A movement that a message of this sender has caused.
  struct Move {
    SenderBit sender = 0;
    Time computed_from{};  ///< SYNC time of the image that the message was computed from
    Time held_until{};     ///< time until which the message certainly gives the node to its sender
  };

  HolderJudge(const BusPlan& plan, Verdict& verdict);

  void moved(std::size_t node_index, const Move& move, Time now);
  /// Call this when this sender has given up its outputs.
  void released(SenderBit sender, Time now);
  /// Call this when a new process of the daemon begins. No sender holds the outputs then.
  void begin_anew();
  /// Notes that an axis of this sender has moved.
  void note_move(SenderBit sender, Time now);
  /// Returns the time at which this sender last moved an axis.
  Time last_move(SenderBit sender) const noexcept;

 private:
  struct Holder {
    SenderBit sender = 0;
    Time until{};
  };

  const BusPlan& plan_;
  Verdict& verdict_;
  std::vector<Holder> holders_;  // holders in the order of BusPlan::nodes
  std::vector<Time> moved_;      // time of the last move, by the number of the sender's bit
  std::vector<Time> released_;   // time of the release, by the number of the sender's bit
};

}  // namespace takt::soak
