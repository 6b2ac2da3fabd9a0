#include "master/core/network/network.hpp"

#include "master/wire/heartbeat.hpp"
#include "master/wire/nmt.hpp"

namespace takt {
namespace {

/// Updates one flag of a list and the number of true flags, `sum`. `known` is the previous value of
/// the flag.
void recount(bool now, std::vector<bool>::reference known, std::size_t& sum) noexcept {
  if (now == known) return;
  known = now;
  sum += now ? 1U : static_cast<std::size_t>(-1);
}

}  // namespace

Network::Network(const BusPlan& plan, NetworkOptions options)
    : plan_{plan},
      observe_{options.observe},
      nmt_stop_{options.nmt_stop},
      lss_{plan, requests_, events_},
      nmt_gate_{plan.start_up.nmt_inhibit},
      start_{plan},
      statuses_(plan.nodes.size()),
      dictionary_{plan, statuses_},
      server_{default_sdo_channel(plan.master_id), dictionary_} {
  index_.fill(no_session);
  answers_.fill(no_session);
  sessions_.reserve(plan.nodes.size());
  for (const NodePlan& node : plan.nodes) {
    const auto position = static_cast<std::uint8_t>(sessions_.size());
    index_[node.id.value()] = position;
    stops_drives_ = stops_drives_ || node.on_loss == LossReaction::quick_stop;
    if (node.emcy_cob_id) emcy_ids_.emplace_back(*node.emcy_cob_id, position);
    answers_[node.sdo.channel_of(node.id).answer.id() & 0x7FF] = position;
    const auto managed = node.boot && !observe_ ? Managed::yes : Managed::no;
    sessions_.emplace_back(
        node, managed,
        NodeSession::Shared{.events = events_,
                            .requests = requests_,
                            .nmt_gate = nmt_gate_,
                            .sub_block_segments = sub_block_segments(plan.bitrate)});
  }
  streams_.resize(sessions_.size());
  awaits_.resize(sessions_.size());
  deadlines_.resize(sessions_.size(), never);
}

NodeSession* Network::session(std::uint32_t node) noexcept {
  if (node >= index_.size() || index_[node] == no_session) return nullptr;
  return &sessions_[index_[node]];
}

void Network::touched(std::size_t index, Time now) noexcept {
  if (sessions_[index].take_loss()) on_loss(index, now);
  statuses_[index] = sessions_[index].status();
  deadlines_[index] = sessions_[index].deadline();
  recount(sessions_[index].streams(), streams_[index], streaming_);
  recount(sessions_[index].awaits_answer(), awaits_[index], awaited_);
}

std::size_t Network::awaited_sub_blocks() const noexcept {
  if (streaming_ == 0) return 0;
  const auto count = std::ranges::count_if(sessions_, &NodeSession::awaits_sub_block);
  return static_cast<std::size_t>(count);
}

void Network::start(Time now) noexcept {
  if (observe_) return;
  if (plan_.master_heartbeat > Time{}) heartbeat_at_ = now;
  start_.begin(now);
  lss_.start(now);
  for (std::size_t i = 0; i < sessions_.size(); ++i) {
    sessions_[i].start(now);
    touched(i, now);
  }
}

void Network::on_frame(const Frame& frame, Time now, Outbox& out) noexcept {
  if (frame.rtr) return;
  if (frame.id == lss::answer_cob_id) return lss_.on_frame(frame, now, out);
  if (NodeSession* const sender = emcy_sender(frame.id)) {
    sender->on_emcy(frame, now);
    return touched(static_cast<std::size_t>(sender - sessions_.data()), now);
  }
  if (frame.id.is_extended()) return;
  if (const std::uint8_t asked = answers_[frame.id.id()]; asked != no_session) {
    sessions_[asked].on_sdo_answer(frame, now);
    return touched(asked, now);
  }
  if (frame.id == default_sdo_channel(plan_.master_id).request) {
    if (!observe_) ask_own_dictionary(frame, now);
    return;
  }
  const std::uint32_t node = frame.id.id() & 0x7F;
  NodeSession* const peer = session(node);
  if (peer == nullptr) return on_unlisted_node(frame, now);
  switch (frame.id.id() & ~0x7FU) {
    case 0x700:
      if (const auto sign = decode_heartbeat(frame)) peer->on_heartbeat(*sign, now);
      break;
    case 0x080:
      peer->on_emcy(frame, now);
      break;
    default:
      return;
  }
  touched(index_[node], now);
}

/// Returns the session of the node whose EMCY has this COB-ID, if it is not the one of the
/// predefined connection set. Returns nullptr if there is none.
NodeSession* Network::emcy_sender(CobId id) noexcept {
  for (const auto& [own, position] : emcy_ids_) {
    if (own == id) return &sessions_[position];
  }
  return nullptr;
}

/// Reports that a node which is not in the network file has shown a sign of life. CiA 302-2, status
/// A.
void Network::on_unlisted_node(const Frame& frame, Time now) noexcept {
  const std::uint32_t node = frame.id.id() & 0x7F;
  const bool sign_of_life = (frame.id.id() & 0x780U) == 0x700 && frame.length != 0 && node != 0;
  if (!sign_of_life || node == plan_.master_id.value() || unlisted_nodes_[node]) return;
  unlisted_nodes_.set(node);
  events_.push({.when = now, .kind = EventKind::unlisted_node, .value = node});
}

void Network::on_time(Time now, Outbox& out) noexcept {
  const std::size_t limit = out.limit();
  const std::size_t budget = std::max<std::size_t>(plan_.cycle.service_frames, 1);
  out.set_limit(std::min(limit, out.frames().size() + budget));
  follow_start(now);
  send_heartbeat(now, out);
  send_own_commands(now, out);
  serve_own_dictionary(now, out);  // It may accept NMT commands, which are sent below.
  send_commands(now, out);
  if (!observe_) lss_.on_time(now, out, statuses_);
  run_sessions(now, out);
  out.set_limit(limit);
}

void Network::send_heartbeat(Time now, Outbox& out) noexcept {
  if (now < heartbeat_at_ || !out.push(encode(Heartbeat{plan_.master_id, own_state_}))) return;
  if (own_state_ == NmtState::bootup) {
    own_state_ = start_.ready() && plan_.start_up.start_master ? NmtState::operational
                                                               : NmtState::preoperational;
  }
  heartbeat_at_ += plan_.master_heartbeat;
  if (heartbeat_at_ <= now) heartbeat_at_ = now + plan_.master_heartbeat;
}

/// Serves a request to the dictionary of the master. NMT commands are refused if there is no room
/// for them, because a confirmed command must not be lost.
void Network::ask_own_dictionary(const Frame& frame, Time now) noexcept {
  using enum SdoServer::Orders;
  const bool refuses = stopping_ || boots_given_up_ || requests_.full();
  server_.on_frame(frame, now, refuses ? refused : taken);
  if (const auto order = server_.take_order()) {
    requests_.accept({.kind = RequestKind::nmt, .node = order->node, .command = order->command});
  }
}

/// Sends the answers of the dictionary of the master. The segments of a block are sent one after
/// the other as long as there is room.
void Network::serve_own_dictionary(Time now, Outbox& out) noexcept {
  while (server_.deadline() <= now && out.room() != 0) server_.on_time(now, out);
}

void Network::run_sessions(Time now, Outbox& out) noexcept {
  // A session may have more than one frame for the same moment, so the loop repeats until `out` is
  // full or no session sends.
  bool again = first_deadline() <= now;
  while (again) {
    again = false;
    std::size_t i = turn_;
    for (std::size_t left = sessions_.size(); left != 0; --left, i = following(i)) {
      if (deadlines_[i] > now) continue;
      if (sessions_[i].on_time(now, out)) {
        again = true;
        turn_ = following(i);
      }
      touched(i, now);
    }
    if (out.room() == 0) return;
  }
}

std::size_t Network::following(std::size_t index) const noexcept {
  return index + 1 == sessions_.size() ? 0 : index + 1;
}

Time Network::first_deadline() const noexcept {
  Time first = never;
  for (const Time deadline : deadlines_) first = std::min(first, deadline);
  return first;
}

Time Network::deadline() const noexcept {
  if (command_ != nullptr || requests_.has_waiting(0) || !broadcasts_.empty()) return at_once;
  return std::min(
      {heartbeat_at_, server_.deadline(), start_.deadline(), lss_.deadline(), first_deadline()});
}

void Network::withdraw(std::uint64_t id) noexcept {
  requests_.withdraw(id);
  for (std::size_t i = 0; i < sessions_.size(); ++i) {
    // The next request of the node may begin.
    if (sessions_[i].withdraw(id)) deadlines_[i] = Time{};
  }
}

bool Network::submit(const Request& request, Time now) noexcept {
  RequestSlot* const slot = requests_.accept(request);
  if (slot == nullptr) return false;
  if (observe_ || stopping_) {
    requests_.answer(*slot, observe_ ? SdoFault::refused : SdoFault::cancelled);
  } else if (request.kind == RequestKind::nmt) {
    if (request.node > 127) requests_.answer(*slot, SdoFault::no_such_node);
  } else if (NodeSession* const peer = session(request.node); peer != nullptr) {
    peer->on_request(now);
    touched(index_[request.node], now);
  } else if (request.kind != RequestKind::lss) {  // LSS requests do not concern a session.
    requests_.answer(*slot, SdoFault::no_such_node);
  }
  return true;
}

std::span<const LimitReading> Network::limits_read(std::size_t node_index) const noexcept {
  if (node_index >= sessions_.size()) return {};
  return sessions_[node_index].limits_read();
}

void Network::begin_stop(Time now, NmtCommand last) noexcept {
  if (stopping_) return;
  stopping_ = true;
  command_master(NmtCommand::enter_preoperational);
  command_ = nullptr;
  awaits_axes_.reset();
  axes_at_rest_.reset();
  while (!broadcasts_.empty()) {
    NmtMessage dropped;
    broadcasts_.pop(dropped);
  }
  lss_.stop(now);
  requests_.cancel_all();
  for (std::size_t i = 0; i < sessions_.size(); ++i) {
    sessions_[i].begin_stop(last);
    touched(i, now);
  }
}

bool Network::idle() const noexcept {
  return !stopping_ && events_.empty() && broadcasts_.empty() && command_ == nullptr &&
         requests_.idle() && lss_.idle() && server_.idle() &&
         std::ranges::all_of(sessions_, &NodeSession::idle);
}

bool Network::stopped() const noexcept {
  return stopping_ && lss_.stopped() && std::ranges::all_of(sessions_, &NodeSession::stopped);
}

}  // namespace takt
