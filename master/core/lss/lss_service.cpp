#include "master/core/lss/lss_service.hpp"

#include <array>
#include <utility>

#include "eds_parser/table/waits.hpp"

namespace takt {
namespace {

using Commands = std::array<LssCommand, LssRunner::most_commands>;

/// Returns the number of commands; 0 if the request is no list of services that a running master
/// offers.
std::size_t unpack(const Request& request, Commands& commands) noexcept {
  const std::size_t count = request.size / lss_command_bytes;
  if (request.size % lss_command_bytes != 0 || count > commands.size()) return 0;
  const std::span bytes{request.data};
  for (std::size_t i = 0; i < count; ++i) {
    const auto command =
        unpack_lss_command(bytes.subspan(i * lss_command_bytes).first<lss_command_bytes>());
    if (!command || command->op == LssOp::activate_bit_timing) return 0;
    commands[i] = *command;
  }
  return count;
}

std::size_t assignment(const NodePlan& node, std::array<LssCommand, 4>& commands) noexcept {
  const LssPlan& lss = *node.lss;
  std::size_t count = 0;
  LssCommand scan{.op = LssOp::fast_scan};
  std::ranges::copy(lss.address, scan.numbers.begin());
  std::ranges::copy(lss.known, scan.numbers.begin() + 4);
  commands[count++] = scan;
  commands[count++] = {.op = LssOp::configure_node_id, .a = node.id.value()};
  if (lss.store) commands[count++] = {.op = LssOp::store};
  commands[count++] = {.op = LssOp::switch_global};
  return count;
}

}  // namespace

LssService::LssService(const BusPlan& plan, RequestTable& requests, EventQueue& events)
    : plan_{plan}, requests_{requests}, events_{events} {
  for (std::size_t i = 0; i < plan.nodes.size(); ++i) {
    if (plan.nodes[i].lss) candidates_.push_back({.node = static_cast<std::uint8_t>(i)});
  }
}

void LssService::start(Time now) noexcept {
  stopping_ = false;
  for (Candidate& candidate : candidates_) candidate.next_look = now + waits::lss_look_again;
}

void LssService::on_frame(const Frame& frame, Time now, Outbox& out) noexcept {
  runner_.on_frame(frame, now, out);
  if (!runner_.running()) finish(now);
}

void LssService::on_time(Time now, Outbox& out, std::span<const NodeStatus> nodes) noexcept {
  if (!runner_.running()) finish(now);
  if (!runner_.running() && !stopping_ && !begin_request()) begin_search(now, nodes);
  runner_.on_time(now, out);
  if (!runner_.running()) finish(now);
}

void LssService::finish(Time now) noexcept {
  if (request_ != nullptr) answer();
  if (searched_ != nullptr) conclude(*std::exchange(searched_, nullptr), now);
}

/// Answers the request; the results replace the commands.
void LssService::answer() noexcept {
  RequestSlot& slot = *std::exchange(request_, nullptr);
  std::size_t size = 0;
  for (const LssResult& result : runner_.results()) {
    pack(result, std::span{slot.request.data}.subspan(size).first<lss_result_bytes>());
    size += lss_result_bytes;
  }
  requests_.answer(slot, runner_.done() ? SdoFault::none : SdoFault::lss_failed, 0, size);
}

bool LssService::begin_request() noexcept {
  request_ = requests_.next(RequestTable::lss_lane);
  if (request_ == nullptr) return false;
  Commands commands;
  const std::size_t count = unpack(request_->request, commands);
  if (count == 0) {
    requests_.answer(*std::exchange(request_, nullptr), SdoFault::lss_refused);
    return true;
  }
  runner_.begin(std::span{commands}.first(count), request_->request.timeout);
  return true;
}

/// Begins a search for a node that has shown no sign of life, because it may have no node-ID.
void LssService::begin_search(Time now, std::span<const NodeStatus> nodes) noexcept {
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    Candidate& candidate = candidates_[(turn_ + i) % candidates_.size()];
    if (now < candidate.next_look) continue;
    const NodeStatus& status = nodes[candidate.node];
    candidate.next_look = now + waits::lss_look_again;
    if (status.boot == BootState::ready || status.nmt != NmtState::unknown) continue;
    std::array<LssCommand, 4> commands;
    const std::size_t count = assignment(plan_.nodes[candidate.node], commands);
    runner_.begin(std::span{commands}.first(count), Time{});
    searched_ = &candidate;
    turn_ = (turn_ + i + 1) % candidates_.size();
    return;
  }
}

/// Returns true if two scans in a row have found only other devices. A single such scan proves
/// nothing: an answer may be lost, or the other device may belong to the node that is searched for
/// next.
bool LssService::only_others_answered(Candidate& candidate) const noexcept {
  const LssResult& scan = runner_.results().front();
  const bool answered = scan.frames > LssFastScan::frames_of_silence;
  const bool others = scan.outcome == LssOutcome::nobody && answered;
  return std::exchange(candidate.others_answer, others) && others;
}

void LssService::report_failure(Candidate& candidate, Time now) noexcept {
  const LssResult& last = runner_.results().back();
  const std::array<std::uint8_t, 4> why{static_cast<std::uint8_t>(last.op),
                                        static_cast<std::uint8_t>(last.outcome), last.error,
                                        last.specific};
  const auto sum = static_cast<std::uint32_t>(why[0] << 24 | why[1] << 16 | why[2] << 8 | why[3]);
  if (std::exchange(candidate.reported, sum) == sum) return;
  Event event{.when = now,
              .kind = EventKind::lss_not_assigned,
              .node = plan_.nodes[candidate.node].id.value()};
  std::ranges::copy(why, event.bytes.begin());
  events_.push(event);
}

void LssService::conclude(Candidate& candidate, Time now) noexcept {
  const NodePlan& node = plan_.nodes[candidate.node];
  const auto results = runner_.results();
  candidate.next_look = now + waits::lss_look_again;
  if (results.empty()) return;
  const bool only_others = only_others_answered(candidate);
  if (results.front().outcome == LssOutcome::nobody && !only_others) return;
  if (runner_.done()) {
    candidate.reported = 0;
  } else {
    report_failure(candidate, now);
  }
  const bool has_id = results.size() > 1 && results[1].outcome == LssOutcome::done;
  if (!has_id) return;
  candidate.next_look = now + waits::lss_let_boot;
  events_.push({.when = now,
                .kind = EventKind::lss_assigned,
                .node = node.id.value(),
                .value = results[0].numbers[3]});
}

Time LssService::deadline() const noexcept {
  if (runner_.running()) return runner_.deadline();
  if (stopping_) return never;
  if (requests_.has_waiting(RequestTable::lss_lane)) return at_once;
  Time first = never;
  for (const Candidate& candidate : candidates_) first = std::min(first, candidate.next_look);
  return first;
}

void LssService::stop(Time now) noexcept {
  stopping_ = true;
  runner_.leave(now);
  request_ = nullptr;
  searched_ = nullptr;
  for (Candidate& candidate : candidates_) candidate.next_look = never;
}

}  // namespace takt
