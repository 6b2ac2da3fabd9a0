#pragma once
#include <cstdint>

#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/values/time.hpp"
#include "master/core/node_status.hpp"
#include "master/core/request_table.hpp"
#include "master/core/sdo/sdo_client.hpp"

namespace takt {

/// Serves the SDO requests of applications for one node, one at a time, while the node is not being
/// booted. The caller passes the SDO client and the status of the node to each call; these must
/// always be the same. Bus thread only.
class NodeRequests {
 public:
  /// `plan` and `table` must outlive the object.
  NodeRequests(const NodePlan& plan, RequestTable& table) noexcept : plan_{&plan}, table_{&table} {}

  /// Returns true if a request is being served.
  bool active() const noexcept { return active_ != nullptr; }
  /// Answers the active request if its transfer has ended.
  void follow(SdoClient& client, NodeStatus& status, Time now) noexcept;
  /// Begins the next request, if one waits; no request must be active.
  void begin_next(SdoClient& client, Time now) noexcept;
  /// Cancels and answers the active request if it has this id and nothing of it was sent so far.
  /// Returns false if there is no such request.
  bool withdraw(std::uint64_t id, SdoClient& client, NodeStatus& status) noexcept;
  /// Answers the active request as cancelled, because the node was reset.
  void cancel() noexcept;
  /// Forgets the active request, which the network answers.
  void forget() noexcept;
  /// Returns the time of the next check whether the sender has cancelled the transfer.
  Time deadline() const noexcept { return next_look_; }

 private:
  void follow_transfer(SdoTransfer& transfer, SdoClient& client, Time now) noexcept;
  void answer(const SdoResult& result, const SdoClient& client, NodeStatus& status) noexcept;
  bool activate_next() noexcept;

  const NodePlan* plan_;
  RequestTable* table_;
  RequestSlot* active_ = nullptr;
  Time next_look_ = never;
};

}  // namespace takt
