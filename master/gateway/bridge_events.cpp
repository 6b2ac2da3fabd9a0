#include <fmt/format.h>
#include <utility>

#include "master/explain/boot_report.hpp"
#include "master/explain/event_text.hpp"
#include "master/gateway/bridge.hpp"
#include "master/lcm/printable_text.hpp"

// The notices of the bridge for the user: events of the bus thread and notices of the bridge
// itself.

namespace takt {
namespace {

bool is_good_limit(const Event& event) noexcept {
  return static_cast<LimitVerdict>(event.detail & 0xFFU) == LimitVerdict::good;
}

}  // namespace

void Bridge::warn(const std::string& kind, const std::string& text) {
  const Time now = clocks_.now();
  announce(Notice{.when = now,
                  .cycle = cycle_at(now),
                  .node = 0,
                  .kind = kind,
                  .weight = Weight::warning,
                  .text = text});
}

void Bridge::report_damaged(const std::string& channel, DecodeFault fault) {
  ++damaged_count_;
  const std::string why{fault == DecodeFault::schema_1 ? schema_refusal(1) : text(fault)};
  const auto kept_back = damaged_.allow(channel + why, clocks_.now());
  if (!kept_back) return;
  warn("bad_message",
       with_kept_back(fmt::format("a message on {} can't be read: {}", channel, why), *kept_back));
}

void Bridge::take_events() {
  const FrontBudget budget{clock_, FrontBudget::events};
  Event event;
  do {
    events_left_ = master_.take(event);
    if (events_left_) take_event(event);
  } while (events_left_ && budget.is_left());
  for (const Notice& notice : outages_.take_due(clocks_.now())) send(notice);
  report_lost_events();
}

void Bridge::take_event(const Event& event) {
  if (guest_ != nullptr) guest_->hear(event);
  emcy_log_.take(event, wall_microseconds(event.when));
  if (event.kind == EventKind::limit_read && is_good_limit(event)) {
    motions_.learn(event.detail >> 8U, event.value);
  }
  announce(event);
}

std::uint64_t Bridge::events_lost() const noexcept {
  return master_.event_overruns() + snapshot_.bus.events_lost;
}

void Bridge::report_lost_events() {
  const std::uint64_t lost = events_lost();
  const std::uint64_t more = lost - std::exchange(events_lost_reported_, lost);
  if (more == 0) return;
  warn("events_lost",
       fmt::format("{}: {} events were lost: more events came at once than the queue holds",
                   subject(master_.plan(), 0), more));
}

/// Adds the data that only the gateway has: the limit that the last command had, and its sender.
Notice Bridge::fallback_notice(Event event) const {
  if (const auto limit = commands_.newest_limit(event.value)) event.bytes = pack_limit(*limit);
  Notice notice = to_notice(master_.plan(), event);
  const std::string_view sender = commands_.last_holder(master_.plan().index_of(event.node));
  if (!sender.empty()) notice.text += fmt::format("; its last sender was '{}'", sender);
  return notice;
}

void Bridge::announce(const Event& event) {
  // A new stop removes the axes of an earlier NMT stop.
  if (event.kind == EventKind::stopping) stop_text_.clear();
  if (event.kind == EventKind::axis_not_stopped) {
    if (std::exchange(stop_reported_, event.when) != event.when) stop_text_.clear();
    stop_text_ += (stop_text_.empty() ? "" : "\n") + named_axis_stop_text(master_.plan(), event);
  }
  if (event.kind == EventKind::stopped) {
    for (const Notice& notice : outages_.take_rest(event.when)) send(notice);
  }
  if (!PdoOutages::concerns(event.kind)) {
    announce(event.kind == EventKind::fallback_begun ? fallback_notice(event)
                                                     : to_notice(master_.plan(), event));
  } else if (const auto notice = outages_.on_event(event)) {
    send(*notice);
  }
}

void Bridge::announce(Notice notice) {
  const auto kept_back = limit_.allow(notice);
  if (!kept_back) return;
  notice.text = with_kept_back(std::move(notice.text), *kept_back);
  send(std::move(notice));
}

/// Sends a notice. Its text may contain texts of devices and senders, and goes to terminals and
/// logs, so it is made printable first.
void Bridge::send(Notice notice) {
  notice.text = printable_lines(notice.text);
  publish(channels_.event, to_message(master_.plan(), notice), notice.when);
  announce_(notice);
}

}  // namespace takt
