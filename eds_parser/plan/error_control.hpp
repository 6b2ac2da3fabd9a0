#pragma once
#include "eds_parser/plan/pdo/effective_pdo.hpp"
#include "eds_parser/report/network_report.hpp"
#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// How the master supervises its nodes: by heartbeat, else by guarding (CiA 301, 7.2.8).
class ErrorControl {
 public:
  ErrorControl(const NetworkSpec& spec, NetworkReport& report) : spec_{spec}, report_{report} {}

  /// Returns 0x1017 of a node in ms: the value of the network file, else of the device file. If
  /// neither has one and the device can produce a heartbeat, the result is 100 ms, or the longer
  /// period with which the heartbeats of all nodes together need less than 2 % of the bus time. The
  /// value is rounded as the device rounds it.
  std::uint16_t producer_ms(const NodeSource& node) const;
  /// Returns the longest silence of the master that a device accepts, in milliseconds, as an entry
  /// of 0x1016 states it. 0 means that the master produces no heartbeat.
  std::uint16_t master_consumer_ms(const NodeSource& node) const;
  /// Returns the number of heartbeat periods without a heartbeat after which a node counts as lost.
  /// The result is at least 1.5.
  double multiplier(const NodeSpec& node) const;
  /// Returns the time without a heartbeat after which a node counts as lost. Returns zero if the
  /// master expects no heartbeat from the node.
  Time heartbeat_timeout(const NodeSource& node) const;
  /// Returns the guarding of a node if the device file or the network file has a guard time and
  /// there is no heartbeat.
  GuardPlan guard(const NodeSource& node);
  /// Notes that `retry_factor` of `options` has no effect if guard() has used it for no node.
  void report_unused_retry_factor() const;

 private:
  std::uint16_t wanted_producer_ms(const NodeSource& node) const;
  void leave_alone(const NodeSpec& spec, const std::string& why,
                   const std::string& remedy = "") const;

  const NetworkSpec& spec_;
  NetworkReport& report_;
  bool guards_ = false;
  bool uses_retry_factor_ = false;  ///< A node is guarded with the retry_factor of `options`.
};

/// Checks that a node with `reset: keep_alive` shows its state by heartbeat or guarding.
void check_keep_alive(const NodeSpec& spec, const NodePlan& node, NetworkReport& report);

}  // namespace takt
