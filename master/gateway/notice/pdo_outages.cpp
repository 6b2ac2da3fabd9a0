#include "master/gateway/notice/pdo_outages.hpp"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <fmt/format.h>
#include <string>

#include "master/explain/boot_report.hpp"
#include "master/explain/report_text.hpp"

namespace takt {
namespace {

constexpr Time pause = std::chrono::seconds{1};
constexpr std::size_t most_lines = 8;

/// Returns the time of the next sum. The sums of all PDOs fall due together, so that many can share
/// a line.
Time next_sum(Time now, Time reported) {
  return std::chrono::ceil<std::chrono::seconds>(std::max(now, reported + pause));
}

std::string how_often(std::uint64_t count) {
  if (count == 1) return "once";
  return count == 2 ? "twice" : fmt::format("{} times", count);
}

std::string still(std::size_t missing) {
  if (missing == 0) return "all are back";
  return fmt::format("{} {} still missing", missing, missing == 1 ? "is" : "are");
}

std::string recent_span_text(Time span) {
  return span <= pause ? "in the last second" : "in the last " + time_text(span);
}

}  // namespace

std::optional<Notice> PdoOutages::on_event(const Event& event) {
  Outage& outage = outages_[{event.node, event.value}];
  const bool first = outage.due == never && event.when - outage.last >= calm;
  outage.missing = event.kind == EventKind::pdo_missing;
  outage.last = event.when;
  outage.cycle = event.cycle;
  if (first || (outage.back_at_once && !outage.missing)) {
    if (first) outage.reported = event.when;
    outage.back_at_once = outage.missing;
    return to_notice(plan_, event);
  }
  outage.back_at_once = false;
  outage.missed += outage.missing;
  if (outage.due == never) {
    outage.since = event.when;
    outage.due = next_sum(event.when, outage.reported);
    next_look_ = std::min(next_look_, outage.due);
  }
  return std::nullopt;
}

std::vector<Notice> PdoOutages::take_due(Time now) {
  if (now < next_look_) return {};
  next_look_ = never;
  std::vector<Row*> due;
  for (Row& row : outages_) {
    if (row.second.due <= now) {
      due.push_back(&row);
    } else {
      next_look_ = std::min(next_look_, row.second.due);
    }
  }
  return announce(due, now);
}

std::vector<Notice> PdoOutages::take_rest(Time now) {
  next_look_ = never;
  std::vector<Row*> rest;
  for (Row& row : outages_) {
    if (row.second.due != never) rest.push_back(&row);
  }
  return announce(rest, now);
}

std::vector<Notice> PdoOutages::announce(const std::vector<Row*>& rows, Time now) {
  std::vector<Notice> notices;
  if (rows.size() > most_lines) {
    notices.push_back(many(rows, now));
  } else {
    for (const Row* row : rows) notices.push_back(one(*row, now));
  }
  for (Row* row : rows) {
    Outage& outage = row->second;
    outage.reported = outage.due;
    outage.due = never;
    outage.missed = 0;
  }
  return notices;
}

Notice PdoOutages::one(const Row& row, Time now) const {
  const auto& [pdo, outage] = row;
  if (outage.missed == 0) {
    return to_notice(plan_, {.when = now,
                             .cycle = outage.cycle,
                             .kind = EventKind::pdo_back,
                             .node = pdo.node,
                             .value = pdo.number});
  }
  return {.when = now,
          .cycle = outage.cycle,
          .node = pdo.node,
          .kind = std::string{name(EventKind::pdo_missing)},
          .weight = Weight::warning,
          .text = fmt::format("{}: TPDO{} was missing {} {}; it is {}", subject(plan_, pdo.node),
                              pdo.number, how_often(outage.missed),
                              recent_span_text(now - outage.since),
                              outage.missing ? "still missing" : "back")};
}

Notice PdoOutages::many(const std::vector<Row*>& rows, Time now) const {
  const auto missed = [](const Row* row) { return row->second.missed; };
  const auto& [worst, outage] = **std::ranges::max_element(rows, {}, missed);
  std::uint64_t total = 0;
  std::size_t missing = 0;
  Time since = now;
  for (const Row* row : rows) {
    total += missed(row);
    missing += row->second.missing;
    since = std::min(since, row->second.since);
  }
  std::string text = fmt::format("{} TPDOs are back", rows.size());
  if (total != 0) {
    text = fmt::format("{} TPDOs were missing {} {}, most often TPDO{} of {} ({}); {}", rows.size(),
                       how_often(total), recent_span_text(now - since), worst.number,
                       subject(plan_, worst.node), how_often(outage.missed), still(missing));
  }
  const EventKind kind = total == 0 ? EventKind::pdo_back : EventKind::pdo_missing;
  return {.when = now,
          .cycle = outage.cycle,
          .node = 0,
          .kind = std::string{name(kind)},
          .weight = weight_of(kind),
          .text = std::move(text)};
}

}  // namespace takt
