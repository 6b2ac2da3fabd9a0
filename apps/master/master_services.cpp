// Member functions of Master for everything besides images and set-points: the states of the nodes,
// events, requests.
#include <algorithm>
#include <utility>

#include "apps/master/master_state.hpp"
#include "master/explain/boot_report.hpp"
#include "master/wire/sdo_abort.hpp"

namespace takt {
namespace {

static_assert(std::to_underlying(NmtService::start) == std::to_underlying(NmtCommand::start));
static_assert(std::to_underlying(NmtService::stop) == std::to_underlying(NmtCommand::stop));
static_assert(std::to_underlying(NmtService::enter_preoperational) ==
              std::to_underlying(NmtCommand::enter_preoperational));
static_assert(std::to_underlying(NmtService::reset_node) ==
              std::to_underlying(NmtCommand::reset_node));
static_assert(std::to_underlying(NmtService::reset_communication) ==
              std::to_underlying(NmtCommand::reset_communication));

Request request_for(RequestKind kind, NodeObject object) {
  Request request;
  request.kind = kind;
  request.node = object.node;
  request.object = {object.index, object.sub};
  return request;
}

NodeState to_public(const NodeStatus& status) {
  return {.nmt = name(status.nmt),
          .boot = name(status.boot),
          .ready = status.boot == BootState::ready && status.exchanging};
}

std::string fault_text(const Reply& reply) {
  if (reply.fault == SdoFault::none) return {};
  std::string text{name(reply.fault)};
  if (reply.abort_code != 0) text.append(": ").append(abort_text(reply.abort_code));
  return text;
}

}  // namespace

NodeState Master::node(std::uint8_t node_id) const {
  const std::size_t index = state_->loaded.plan.index_of(node_id);
  StatusSnapshot snapshot;
  state_->run.status(snapshot);
  return to_public(index < snapshot.nodes.size() ? snapshot.nodes[index] : NodeStatus{});
}

bool Master::all_ready() const {
  StatusSnapshot snapshot;
  state_->run.status(snapshot);
  for (std::size_t i = 0; i < snapshot.nodes.size(); ++i) {
    if (state_->loaded.plan.nodes[i].boot && !to_public(snapshot.nodes[i]).ready) return false;
  }
  return true;
}

std::optional<MasterEvent> Master::take_event() {
  Event event;
  if (!state_->run.take(event)) return std::nullopt;
  return MasterEvent{.time = event.when,
                     .cycle = event.cycle,
                     .node = event.node,
                     .kind = std::string{name(event.kind)},
                     .text = describe(state_->loaded.plan, event)};
}

std::optional<RequestId> Master::read(NodeObject object) {
  Request request = request_for(RequestKind::sdo_upload, object);
  return state_->submit(request);
}

std::optional<RequestId> Master::write(NodeObject object, std::span<const std::byte> data) {
  if (data.empty() || data.size() > request_bytes) return std::nullopt;
  Request request = request_for(RequestKind::sdo_download, object);
  request.size = static_cast<std::uint16_t>(data.size());
  std::ranges::copy(data, request.data.begin());
  return state_->submit(request);
}

std::optional<RequestId> Master::nmt(NmtService service, std::uint8_t node_id) {
  Request request = request_for(RequestKind::nmt, {.node = node_id});
  request.command = static_cast<NmtCommand>(service);
  return state_->submit(request);
}

std::optional<ServiceReply> Master::take_reply() {
  Reply reply;
  if (!state_->run.take(reply)) return std::nullopt;
  return ServiceReply{.request = reply.id,
                      .good = reply.fault == SdoFault::none,
                      .abort_code = reply.abort_code,
                      .text = fault_text(reply),
                      .data = {reply.data.begin(), reply.data.begin() + reply.size}};
}

}  // namespace takt
