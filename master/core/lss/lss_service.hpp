#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"
#include "master/core/event_queue.hpp"
#include "master/core/lss/lss_runner.hpp"
#include "master/core/machine.hpp"
#include "master/core/node_status.hpp"
#include "master/core/request_table.hpp"

namespace takt {

/// LSS in a running network. It serves the requests of applications. When there is no request, it
/// assigns node-IDs to nodes for which the network file permits this and which show no sign of
/// life. Bus thread only.
class LssService {
 public:
  LssService(const BusPlan& plan, RequestTable& requests, EventQueue& events);

  /// Begins to search for nodes without node-ID.
  void start(Time now) noexcept;
  void on_frame(const Frame& frame, Time now, Outbox& out) noexcept;
  void on_time(Time now, Outbox& out, std::span<const NodeStatus> nodes) noexcept;
  Time deadline() const noexcept;
  /// Cancels all work; the network answers the requests. No device stays in configuration state.
  void stop(Time now) noexcept;
  bool stopped() const noexcept { return stopping_ && !runner_.running(); }
  /// Returns true if no search and no request is running.
  bool idle() const noexcept {
    return !runner_.running() && searched_ == nullptr && request_ == nullptr && !stopping_;
  }

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(runner_);
    state.position(turn_, std::max<std::size_t>(candidates_.size(), 1));
    for (Candidate& candidate : candidates_) {
      state(candidate.next_look, candidate.reported, candidate.others_answer);
    }
  }

 private:
  struct Candidate {
    std::uint8_t node = 0;  // index into plan.nodes
    Time next_look = never;
    std::uint32_t reported = 0;  // the failure that was reported last
    bool others_answer = false;  // other devices without node-ID have answered
  };

  void finish(Time now) noexcept;
  void answer() noexcept;
  bool only_others_answered(Candidate& candidate) const noexcept;
  void report_failure(Candidate& candidate, Time now) noexcept;
  void conclude(Candidate& candidate, Time now) noexcept;
  bool begin_request() noexcept;
  void begin_search(Time now, std::span<const NodeStatus> nodes) noexcept;

  const BusPlan& plan_;
  RequestTable& requests_;
  EventQueue& events_;
  LssRunner runner_;
  std::vector<Candidate> candidates_;
  std::size_t turn_ = 0;            // candidate of the next search
  Candidate* searched_ = nullptr;   // candidate of the running search; nullptr if there is none
  RequestSlot* request_ = nullptr;  // request of the running services; nullptr if there is none
  bool stopping_ = false;
};

}  // namespace takt
