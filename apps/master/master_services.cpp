// Member functions of Master::State for everything besides images and set-points: the states of the
// nodes, events, requests.
#include <algorithm>
#include <utility>

#include "apps/master/master_state.hpp"
#include "master/explain/boot_report.hpp"
#include "master/wire/sdo_abort.hpp"

namespace takt {
namespace {

NodeState to_public(const NodeStatus& status) {
  return {.nmt = name(status.nmt),
          .boot = name(status.boot),
          .ready = status.boot == BootState::ready && status.nmt == NmtState::operational};
}

std::string fault_text(const Reply& reply) {
  if (reply.fault == SdoFault::none) return {};
  std::string text{name(reply.fault)};
  if (reply.abort_code != 0) text.append(": ").append(abort_text(reply.abort_code));
  return text;
}

}  // namespace

NodeState Master::State::node(std::uint8_t node_id) const {
  const std::size_t index = loaded_.plan.index_of(node_id);
  StatusSnapshot snapshot;
  run_.status(snapshot);
  return to_public(index < snapshot.nodes.size() ? snapshot.nodes[index] : NodeStatus{});
}

bool Master::State::all_ready() const {
  StatusSnapshot snapshot;
  run_.status(snapshot);
  for (std::size_t i = 0; i < snapshot.nodes.size(); ++i) {
    if (loaded_.plan.nodes[i].boot && !to_public(snapshot.nodes[i]).ready) return false;
  }
  return true;
}

std::optional<MasterEvent> Master::State::take_event() {
  Event event;
  if (!run_.take(event)) return std::nullopt;
  return MasterEvent{.time = event.when,
                     .cycle = event.cycle,
                     .node = event.node,
                     .kind = std::string{name(event.kind)},
                     .text = describe(loaded_.plan, event)};
}

std::optional<RequestId> Master::State::submit(Request& request) {
  request.id = newest_request_ + 1;
  if (!run_.submit(request)) return std::nullopt;
  return ++newest_request_;
}

std::optional<ServiceReply> Master::State::take_reply() {
  Reply reply;
  if (!run_.take(reply)) return std::nullopt;
  return ServiceReply{.request = reply.id,
                      .good = reply.fault == SdoFault::none,
                      .abort_code = reply.abort_code,
                      .text = fault_text(reply),
                      .data = {reply.data.begin(), reply.data.begin() + reply.size}};
}

}  // namespace takt
