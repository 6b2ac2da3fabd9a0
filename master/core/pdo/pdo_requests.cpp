#include "master/core/pdo/pdo_requests.hpp"

#include <algorithm>
#include <iterator>

namespace takt {
namespace {

Frame remote_request(const PdoRow& row) noexcept {
  return {.id = row.cob_id, .length = row.length, .rtr = true};
}

/// Returns the row of this PDO, or rows.size() if there is none.
std::size_t find(const std::vector<PdoRow>& rows, std::uint8_t node, std::uint16_t number) {
  const auto found = std::ranges::find_if(rows, [&](const PdoRow& row) {
    return row.node.value() == node && row.number == number && !row.multiplexed();
  });
  return static_cast<std::size_t>(found - rows.begin());
}

}  // namespace

PdoRequests::PdoRequests(const BusPlan& plan)
    : plan_{plan},
      late_answer_until_(plan.pdos.tpdos.size(), never),
      sent_(plan.pdos.rpdos.size()) {
  for (std::size_t i = 0; i < plan.pdos.tpdos.size(); ++i) {
    const PdoRow& row = plan.pdos.tpdos[i];
    if (row.poll > Time{} || row.poll_syncs != 0) {
      polls_.push_back({.row = static_cast<std::uint16_t>(i)});
    }
  }
}

/// Determines the frame to send and the TPDO that answers it.
SdoFault PdoRequests::prepare(const Request& request, Slot& slot) const noexcept {
  const std::size_t tpdo = find(plan_.pdos.tpdos, request.node, request.object.index);
  if (tpdo == plan_.pdos.tpdos.size()) return SdoFault::no_such_pdo;
  slot.tpdo = static_cast<std::uint16_t>(tpdo);
  if (request.kind == RequestKind::pdo_poll) {
    slot.frame = remote_request(plan_.pdos.tpdos[tpdo]);
    return SdoFault::none;
  }
  const std::size_t rpdo = find(plan_.pdos.rpdos, request.node, request.object.index);
  if (rpdo == plan_.pdos.rpdos.size() || !plan_.pdos.rpdos[rpdo].on_request) {
    return SdoFault::no_such_pdo;
  }
  slot.rpdo = static_cast<std::uint16_t>(rpdo);
  const PdoRow& row = plan_.pdos.rpdos[rpdo];
  const bool mapped = row.length != 0;  // otherwise the mapping is unknown
  if (mapped && request.size != row.length) return SdoFault::wrong_length;
  if (request.size > slot.frame.data.size()) return SdoFault::too_long;
  slot.frame = {.id = row.cob_id, .length = static_cast<std::uint8_t>(request.size)};
  for (std::size_t i = 0; i < request.size; ++i) {
    slot.frame.data[i] = std::to_integer<std::uint8_t>(request.data[i]);
  }
  return SdoFault::none;
}

bool PdoRequests::submit(const Request& request, Time now) noexcept {
  const auto slot = std::ranges::find(slots_, Slot::State::free, &Slot::state);
  if (slot == slots_.end()) return false;
  *slot = Slot{.state = Slot::State::to_send, .id = request.id, .order = ++order_};
  ++used_;
  slot->timeout = request.timeout > Time{} ? request.timeout : waits::pdo_answer;
  // Earlier requests may wait for the same PDO one after another. After an exchange that has timed
  // out, the master also waits for its late answer.
  const Time::rep turns = request.kind == RequestKind::pdo_exchange ? 2 : 1;
  slot->deadline = now + turns * waits::pdo_turn(slot->timeout);
  const SdoFault fault = prepare(request, *slot);
  if (fault != SdoFault::none) answer(*slot, fault);
  return true;
}

void PdoRequests::answer(Slot& slot, SdoFault fault) noexcept {
  if (slot.state == Slot::State::sent) --waiting_;
  slot.state = Slot::State::answered;
  slot.fault = fault;
  if (fault != SdoFault::none) slot.frame.length = 0;
}

/// Ends a request that has timed out. Its answer may still come and must not be taken for the
/// answer to the next request. This does not apply to a remote frame, because every frame of its
/// PDO is a valid answer.
void PdoRequests::give_up(Slot& slot, Time now) noexcept {
  if (slot.state == Slot::State::sent && !slot.frame.rtr) {
    Time& until = late_answer_until_[slot.tpdo];
    late_answers_ += until == never;
    until = now + slot.timeout;
  }
  answer(slot, SdoFault::timeout);
}

void PdoRequests::forget_late_answers(Time now) noexcept {
  for (Time& until : late_answer_until_) {
    if (now < until) continue;
    until = never;
    --late_answers_;
  }
}

/// Returns true if the request may be sent now. Only one request at a time is permitted for each
/// TPDO, because answers carry no number.
bool PdoRequests::is_next(const Slot& slot) const noexcept {
  if (late_answer_until_[slot.tpdo] != never) return false;
  return std::ranges::none_of(slots_, [&](const Slot& other) {
    const bool open = other.state == Slot::State::to_send || other.state == Slot::State::sent;
    return open && other.tpdo == slot.tpdo && other.order < slot.order;
  });
}

void PdoRequests::send(Slot& slot, std::span<const bool> exchanging, Time now,
                       Outbox& out) noexcept {
  if (!exchanging[plan_.pdos.tpdos[slot.tpdo].node_index]) {
    return answer(slot, SdoFault::not_exchanging);
  }
  if (!is_next(slot) || !out.push(slot.frame)) return;
  if (!slot.frame.rtr) ++sent_[slot.rpdo];
  slot.state = Slot::State::sent;
  slot.sent_at = now;
  slot.deadline = now + slot.timeout;
  ++waiting_;
}

/// Returns true if a poll is due. The tolerance of an eighth of the period lets a poll with the
/// period of the cycle be due in each cycle, although this thread does not always wake up at
/// exactly the same phase.
bool PdoRequests::is_due(const Poll& poll, std::uint64_t beat, Time now) const noexcept {
  const PdoRow& row = plan_.pdos.tpdos[poll.row];
  if (row.poll > Time{}) return now >= poll.next - plan_.cycle.period / 8;
  return beat != poll.last_beat && beat % row.poll_syncs == 0;
}

void PdoRequests::on_time(std::span<const bool> exchanging, std::uint64_t beat, Time now,
                          Outbox& out) noexcept {
  for (Poll& poll : polls_) {
    const PdoRow& row = plan_.pdos.tpdos[poll.row];
    if (!exchanging[row.node_index] || !is_due(poll, beat, now)) continue;
    if (!out.push(remote_request(row))) break;
    poll.next = poll.next + row.poll > now ? poll.next + row.poll : now + row.poll;
    poll.last_beat = beat;
  }
  if (late_answers_ != 0) forget_late_answers(now);
  if (used_ == 0) return;
  for (Slot& slot : slots_) {
    const bool open = slot.state == Slot::State::to_send || slot.state == Slot::State::sent;
    if (open && now >= slot.deadline) give_up(slot, now);
    if (slot.state == Slot::State::to_send) send(slot, exchanging, now, out);
  }
}

void PdoRequests::extend_deadlines(Time away) noexcept {
  for (Slot& slot : slots_) slot.deadline += away;
  for (Time& until : late_answer_until_) {
    if (until != never) until += away;
  }
}

void PdoRequests::on_frame(std::uint16_t row, const StampedFrame& stamped) noexcept {
  if (stamped.frame.rtr) return;
  if (late_answer_until_[row] != never) {
    late_answer_until_[row] = never;
    --late_answers_;
    return;
  }
  for (Slot& slot : slots_) {
    const bool waits = slot.state == Slot::State::sent && slot.tpdo == row;
    if (!waits || stamped.when < slot.sent_at) continue;
    slot.frame = stamped.frame;
    answer(slot, SdoFault::none);
  }
}

bool PdoRequests::take(Reply& reply) noexcept {
  if (used_ == 0) return false;
  const auto slot = std::ranges::find(slots_, Slot::State::answered, &Slot::state);
  if (slot == slots_.end()) return false;
  reply = Reply{.id = slot->id, .fault = slot->fault, .size = slot->frame.length};
  for (std::size_t i = 0; i < slot->frame.length; ++i) {
    reply.data[i] = std::byte{slot->frame.data[i]};
  }
  slot->state = Slot::State::free;
  --used_;
  return true;
}

bool PdoRequests::reaches(std::uint8_t node) const noexcept {
  return std::ranges::any_of(slots_, [&](const Slot& slot) {
    const bool open = slot.state == Slot::State::to_send || slot.state == Slot::State::sent;
    return open && plan_.pdos.tpdos[slot.tpdo].node.value() == node;
  });
}

void PdoRequests::cancel_all() noexcept {
  for (Slot& slot : slots_) {
    if (slot.state == Slot::State::to_send || slot.state == Slot::State::sent) {
      answer(slot, SdoFault::cancelled);
    }
  }
}

}  // namespace takt
