#pragma once
#include <cstdint>
#include <optional>
#include <utility>

#include "eds_parser/values/time.hpp"
#include "master/core/node_status.hpp"
#include "master/wire/emcy.hpp"
#include "master/wire/heartbeat.hpp"

namespace takt {

/// Evaluates the heartbeats and the EMCYs of a node, and its silence. Writes the results to the
/// NodeStatus. Bus thread only.
class NodeWatch {
 public:
  /// `heartbeat_timeout` is the longest permitted silence; 0 means that the heartbeat is not
  /// supervised.
  explicit NodeWatch(Time heartbeat_timeout) noexcept : timeout_{heartbeat_timeout} {}

  /// The meaning of a heartbeat or boot-up message.
  enum class Sign : std::uint8_t { bootup, same_state, new_state };

  /// Takes a heartbeat or a boot-up message. The first heartbeat starts the heartbeat consumer. A
  /// boot-up message is not a heartbeat and stops the consumer. CiA 301, 7.2.8.2.2.
  Sign on_heartbeat(NmtState state, Time now, NodeStatus& status) noexcept;
  /// Stops the supervision, because the node was reset or silence is expected for another reason.
  void disarm() noexcept { deadline_ = never; }
  /// Extends the deadline by the time for which the master itself did not run, because this time is
  /// no silence of the node.
  void extend_deadlines(Time away) noexcept {
    if (deadline_ != never) deadline_ += away;
  }
  Time deadline() const noexcept { return deadline_; }
  /// Returns the time of silence once, when the heartbeat is lost. The next heartbeat starts the
  /// supervision again.
  std::optional<Time> on_time(Time now, NodeStatus& status) noexcept;
  /// Notes that the node is silent, as another supervision (node guarding) has found out.
  void note_loss(NodeStatus& status) noexcept;
  /// Ends the silence that was noted, because a heartbeat has come or the node is booted. Returns
  /// false if the node was not silent.
  bool end_silence() noexcept { return std::exchange(silent_, false); }

  /// Counts an EMCY. Returns true if it is to be reported; at most ten EMCYs of a node
  /// are reported in a second.
  bool on_emcy(const Emcy& emcy, Time now, NodeStatus& status) noexcept;
  /// Returns the number of EMCYs that were not reported since the last call.
  std::uint32_t take_unreported_emcys() noexcept { return std::exchange(unreported_emcys_, 0U); }

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(deadline_, silent_, emcy_window_, emcys_in_window_, unreported_emcys_);
  }

 private:
  static constexpr std::uint32_t emcys_per_second = 10;

  Time timeout_;
  Time deadline_ = never;
  bool silent_ = false;  // the node was lost, and no heartbeat has come since
  Time emcy_window_{};   // begin of the second in which EMCYs are counted
  std::uint32_t emcys_in_window_ = 0;
  std::uint32_t unreported_emcys_ = 0;
};

}  // namespace takt
