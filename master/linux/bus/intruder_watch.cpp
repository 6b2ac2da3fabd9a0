#include "master/linux/bus/intruder_watch.hpp"

#include <algorithm>
#include <limits>

namespace takt {
namespace {

constexpr std::uint16_t none = 0xFFFF;
constexpr std::uint32_t window_syncs = 32;
constexpr std::uint8_t unasked_limit = 3;
// A silent node may still answer this number of unanswered requests.
constexpr int most_asked = 8;
constexpr std::size_t max_events = 64;
constexpr Time report_again = std::chrono::seconds{10};
constexpr Time adjust_every = std::chrono::seconds{1};
constexpr std::uint8_t sdo_abort = 0x80;

}  // namespace

IntruderWatch::IntruderWatch(const BusPlan& plan) : sync_id_{plan.cycle.sync_cob_id} {
  own_index_.fill(none);
  cyclic_index_.fill(none);
  const auto add_own = [this](CobId id, EventKind kind) {
    if (id.is_extended() || own_index_[id.id()] != none) return;
    own_index_[id.id()] = static_cast<std::uint16_t>(own_.size());
    own_.push_back({.id = id, .kind = kind, .last = {}});
  };
  add_own(CobId::base(0x000), EventKind::foreign_nmt);
  if (plan.cycle.makes_sync()) add_own(sync_id_, EventKind::foreign_sync);
  add_own(CobId::base(0x700U + plan.master_id.value()), EventKind::duplicate_cob_id);
  for (const PdoRow& row : plan.pdos.rpdos) add_own(row.cob_id, EventKind::duplicate_cob_id);

  for (const PdoRow& row : plan.pdos.tpdos) {
    if (!row.cyclic() || row.cob_id.is_extended()) continue;
    cyclic_index_[row.cob_id.id()] = static_cast<std::uint16_t>(cyclic_.size());
    cyclic_.push_back({.id = row.cob_id, .node = row.node.value(), .every = row.transmission});
  }
}

void IntruderWatch::on_frame(const StampedFrame& stamped, Origin origin) {
  const Frame& frame = stamped.frame;
  if (frame.id.is_extended() || frame.rtr) return;
  const std::uint32_t id = frame.id.id();
  if (frame.id == sync_id_) watch_sync_interval(stamped.when);
  if (own_index_[id] != none) watch_own(own_[own_index_[id]], stamped, origin);
  if (cyclic_index_[id] != none) ++cyclic_[cyclic_index_[id]].seen;
  watch_sdo(stamped);
}

void IntruderWatch::watch_own(Own& own, const StampedFrame& frame, Origin origin) {
  if (origin == Origin::wire) {
    announce(own.kind, own.id, 0, frame.frame, frame.when);
    return;
  }
  ++own.seen;
  own.last = frame.frame;
}

void IntruderWatch::watch_sync_interval(Time now) {
  if (++syncs_ < window_syncs) return;
  syncs_ = 0;
  for (Cyclic& row : cyclic_) {
    const std::uint32_t due = window_syncs / row.every + 2;
    if (row.seen > due + due / 2) announce(EventKind::duplicate_cob_id, row.id, row.node, {}, now);
    row.seen = 0;
  }
}

void IntruderWatch::watch_sdo(const StampedFrame& stamped) {
  const std::uint32_t function = stamped.frame.id.id() & ~0x7FU;
  const std::uint32_t node = stamped.frame.id.id() & 0x7F;
  if (node == 0 || (function != 0x600 && function != 0x580)) return;
  SdoServer& server = servers_[node];
  const unsigned command = stamped.frame.data[0] >> 5;
  if (function == 0x600) {
    server.asked = static_cast<std::uint8_t>(std::min(server.asked + 1, most_asked));
    if (command == 5 || command == 6) server.block = true;
    if (command == 1 || command == 2) server.block = false;
    return;
  }
  const bool expected = server.asked > 0 || server.block || stamped.frame.data[0] == sdo_abort;
  if (server.asked > 0) --server.asked;
  if (expected || ++server.unasked < unasked_limit) return;
  server.unasked = 0;
  announce(EventKind::duplicate_cob_id, stamped.frame.id, static_cast<std::uint8_t>(node),
           stamped.frame, stamped.when);
}

/// Compares the counts. If the diagnostic socket itself loses frames, `seen` never reaches the
/// count of the sent frames again. Frames that are still on their way make `seen` lag for a moment
/// only. A lag that has lasted a whole second therefore counts as loss, and `seen` is corrected.
void IntruderWatch::on_drained(const SentFrames& sent, Time now) {
  const bool adjust = now - adjusted_ >= adjust_every;
  for (Own& own : own_) {
    const std::uint32_t count = sent.of(own.id);
    const auto behind = static_cast<std::int32_t>(count - own.seen);
    if (!started_) own.seen = count;
    if (started_ && behind < 0) {
      announce(own.kind, own.id, 0, own.last, now);
      own.seen = count;
    }
    own.least_behind = std::min(own.least_behind, static_cast<std::uint32_t>(std::max(behind, 0)));
    if (!adjust) continue;
    own.seen += started_ ? own.least_behind : 0;
    own.least_behind = std::numeric_limits<std::uint32_t>::max();
  }
  started_ = true;
  if (adjust) adjusted_ = now;
}

void IntruderWatch::announce(EventKind kind, CobId id, std::uint8_t node, const Frame& frame,
                             Time now) {
  Time& reported = reported_[id.id() & 0x7FF];
  if ((reported != Time{} && now - reported < report_again) || events_.size() == max_events) return;
  reported = now;
  Event event{.when = now, .kind = kind, .node = node};
  event.value = id.id();
  event.bytes = frame.data;
  events_.push_back(event);
}

bool IntruderWatch::take(Event& event) {
  if (events_.empty()) return false;
  event = events_.front();
  events_.erase(events_.begin());
  return true;
}

}  // namespace takt
