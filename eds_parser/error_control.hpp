#pragma once
#include "eds_parser/effective_pdo.hpp"
#include "eds_parser/network_report.hpp"
#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// How the master sees that its nodes live: by heartbeat, else by guarding (CiA 301, 7.2.8).
class ErrorControl {
 public:
  ErrorControl(const NetworkSpec& spec, NetworkReport& report) : spec_{spec}, report_{report} {}

  /// 0x1017 of a node in ms: of the network file; else of the device file; else, where the device
  /// can, 100 ms or as much as keeps all heartbeats below 2 % of the bus. As the device keeps it.
  std::uint16_t producer_ms(const NodeSource& node) const;
  /// For how long a device is to take the silence of the master, in ms of 0x1016; 0: no heartbeat.
  std::uint16_t master_consumer_ms(const NodeSource& node) const;
  /// Of how many heartbeat periods the silence ends a node's life; at least 1.5.
  double multiplier(const NodeSpec& node) const;
  /// Zero: no heartbeat is expected.
  Time heartbeat_timeout(const NodeSource& node) const;
  /// Guarding where the device file or the network file has a guard time and there is no heartbeat.
  GuardPlan guard(const NodeSource& node);
  /// Tells of `retry_factor` of `options` where guard() gave it to no node.
  void tell_unused_retry_factor() const;

 private:
  std::uint16_t wanted_producer_ms(const NodeSource& node) const;
  void leave_alone(const NodeSpec& spec, const std::string& why,
                   const std::string& remedy = "") const;

  const NetworkSpec& spec_;
  NetworkReport& report_;
  bool guards_ = false;
  bool uses_retry_factor_ = false;  ///< that of `options`
};

/// A node that is to be kept running has to show its state.
void check_keep_alive(const NodeSpec& spec, const NodePlan& node, NetworkReport& report);

}  // namespace takt
