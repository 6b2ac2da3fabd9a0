#include "eds_parser/budget/budget.hpp"

#include <algorithm>
#include <utility>

#include "eds_parser/budget/cycle_bounds.hpp"
#include "eds_parser/plan/cycle_compiler.hpp"
#include "eds_parser/plan/frame_time.hpp"

namespace takt {
namespace {

using Bounds = std::vector<std::optional<Time>>;

bool same_identifier(const TrafficFrame& a, const TrafficFrame& b) noexcept {
  return a.cob_id == b.cob_id && a.remote_request == b.remote_request;
}

/// Computes bounds of the frames outside the cycle, which may come at any time. Frames of the cycle
/// count as streams with jitter.
class Others {
 public:
  Others(const BusTraffic& traffic, const CycleBounds& cycle, const BusPlan& plan,
         const BudgetOptions& options, OtherTraffic other_traffic)
      : traffic_{traffic},
        cycle_{cycle},
        plan_{plan},
        options_{options},
        other_traffic_{other_traffic} {}

  Bounds run() {
    const auto sync = std::ranges::find(traffic_.frames, Traffic::sync, &TrafficFrame::kind);
    if (sync != traffic_.frames.end()) {
      const auto end = cycle_.ends[static_cast<std::size_t>(sync - traffic_.frames.begin())];
      // If SYNC has no bound, the TPDOs that follow it have none, either.
      if (!end) return Bounds(traffic_.frames.size());
      sync_end_ = *end;
      sync_frame_ = sync->frame;
    }
    make_streams();
    const Time bit = wire_time(1, plan_.bitrate);
    if (other_traffic_.services == Services::apart)
      return worst_responses(streams_, bit, options_.errors);
    // In one queue, each service frame may wait for all frames that have priority over the service
    // frame with the lowest priority.
    const auto services = with_services_together();
    const Bounds together = worst_responses(services, bit, options_.errors);
    for (std::size_t i = 0; i < streams_.size(); ++i) {
      if (!is_service(i)) continue;
      if (!together[i]) return Bounds(streams_.size());
      streams_[i].jitter = *together[i] - streams_[i].frame;
    }
    Bounds all = worst_responses(streams_, bit, options_.errors);
    for (std::size_t i = 0; i < streams_.size(); ++i) {
      if (is_service(i)) all[i] = together[i];
    }
    return all;
  }

 private:
  bool is_service(std::size_t i) const { return traffic_.frames[i].is_service(); }

  void make_streams() {
    std::size_t priority = 0;
    for (std::size_t i = 0; i < traffic_.frames.size(); ++i) {
      const auto& frame = traffic_.frames[i];
      if (i == 0 || !same_identifier(traffic_.frames[i - 1], frame)) priority = i;
      const bool counts = frame.kind != Traffic::emcy || other_traffic_.emcys == Emcys::one_of_each;
      streams_.push_back({.priority = priority,
                          .frame = frame.frame,
                          .period = frame.period,
                          .jitter = jitter_of(frame),
                          .burst = frame.burst,
                          .counts = counts});
    }
  }

  Time jitter_of(const TrafficFrame& frame) const {
    if (frame.kind == Traffic::sync) return sync_end_ - sync_frame_;
    if (frame.is_input()) return sync_end_ + options_.device_time;
    const bool with_sync = frame.in_cycle && frame.from_master && !plan_.cycle.makes_sync();
    const Time jitter = with_sync ? sync_end_ - sync_frame_ : frame.jitter;
    return frame.in_cycle ? jitter + cycle_.outputs_wait : jitter;
  }

  std::vector<FrameStream> with_services_together() const {
    std::vector<FrameStream> all = streams_;
    std::size_t lowest = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (is_service(i)) lowest = all[i].priority;
    }
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (is_service(i)) all[i].priority = lowest;
    }
    return all;
  }

  const BusTraffic& traffic_;
  const CycleBounds& cycle_;
  const BusPlan& plan_;
  const BudgetOptions& options_;
  OtherTraffic other_traffic_;
  Time sync_end_{};
  Time sync_frame_{};
  std::vector<FrameStream> streams_;
};

Bounds bounds(const BusTraffic& traffic, const BusPlan& plan, const BudgetOptions& options,
              OtherTraffic other_traffic) {
  CycleBounds cycle = cycle_bounds(traffic, plan, options, other_traffic);
  const Bounds others = Others{traffic, cycle, plan, options, other_traffic}.run();
  for (std::size_t i = 0; i < others.size(); ++i) {
    if (!traffic.frames[i].in_cycle) cycle.ends[i] = others[i];
  }
  return std::move(cycle.ends);
}

/// Returns bounds for cycles in which no event-driven output changes. An event-driven output itself
/// gets the bound of the last output that is sent.
Bounds steady_bounds(const BusTraffic& traffic, const BusPlan& plan, const BudgetOptions& options) {
  const auto changes = [](const TrafficFrame& frame) {
    return frame.is_output() && frame.on_change;
  };
  BusTraffic steady = traffic;
  std::erase_if(steady.frames, changes);
  const Bounds found = bounds(steady, plan, options, {});
  Bounds all(traffic.frames.size());
  std::optional<Time> last{plan.cycle.output_deadline};
  for (std::size_t i = 0, k = 0; i < all.size(); ++i) {
    if (changes(traffic.frames[i])) continue;
    all[i] = found[k++];
    if (traffic.frames[i].is_output())
      last = last && all[i] ? std::optional{std::max(*last, *all[i])} : std::nullopt;
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (changes(traffic.frames[i])) all[i] = last;
  }
  return all;
}

/// Returns the earliest time at which the next SYNC is queued, on the time scale of the rows.
Time next_sync(const BusPlan& plan, const std::optional<Time>& sync_end) {
  if (plan.cycle.makes_sync()) return plan.cycle.period;
  return plan.cycle.period - std::min(sync_end.value_or(Time{0}), plan.cycle.period);
}

void limit_input(BudgetRow& row, const CyclePlan& cycle) {
  if (!row.frame.awaited) return;
  row.limit = cycle.receive_window;
  row.why = BudgetLimit::receive_window;
  if (cycle.output_deadline < row.limit) {
    row.limit = cycle.output_deadline;
    row.why = BudgetLimit::output_deadline;
  }
}

void set_limits(BudgetRow& row, const BusPlan& plan, Time next) {
  if (!row.frame.in_cycle || row.frame.kind == Traffic::sync) {
    row.limit = row.frame.limit.value_or(Time{0});
    row.why = row.frame.why;
    return;
  }
  row.cycle = next;
  // Outputs leave the same queue as SYNC and may delay it, up to the delay from which the master
  // reports SYNC as late.
  if (row.frame.kind == Traffic::rpdo) row.tolerance = plan.cycle.period / 10;
  if (row.frame.kind == Traffic::tpdo) limit_input(row, plan.cycle);
  const Time window = plan.cycle.sync_window;
  if (window > Time{0} && (row.why == BudgetLimit::none || window < row.limit)) {
    row.limit = window;
    row.why = BudgetLimit::sync_window;
  }
}

bool asks_for(const TrafficFrame& request, const TrafficFrame& answer) noexcept {
  if (answer.kind == Traffic::sdo) return request.kind == Traffic::sdo && request.from_master;
  return request.remote_request && request.cob_id == answer.cob_id;
}

/// The limit of an answer counts from its request, because the sender of the request has waited
/// since then.
void limit_answers(std::vector<TrafficFrame>& frames, const Bounds& worst) {
  for (auto& answer : frames) {
    if (!answer.answers || !answer.limit) continue;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      if (!asks_for(frames[i], answer) || !worst[i]) continue;
      answer.limit = std::max(*answer.limit - *worst[i], Time{0});
    }
  }
}

/// Computes the budget with only those columns that affect the verdict.
BusBudget judged(BusTraffic traffic, const BusPlan& plan, const BudgetOptions& options) {
  const Bounds quiet = bounds(traffic, plan, options, {});
  const Bounds steady = steady_bounds(traffic, plan, options);
  BusBudget budget{.load = bus_load(traffic, plan.bitrate),
                   .rows = {},
                   .service_dialogues = traffic.service_dialogues,
                   .service_round = traffic.service_round,
                   .assumptions = std::move(traffic.assumptions),
                   .refused = !fits_period(plan)};
  limit_answers(traffic.frames, quiet);
  std::optional<Time> sync_end;
  for (std::size_t i = 0; i < traffic.frames.size(); ++i) {
    if (traffic.frames[i].kind == Traffic::sync) sync_end = quiet[i];
  }
  for (std::size_t i = 0; i < traffic.frames.size(); ++i) {
    BudgetRow row{.frame = std::move(traffic.frames[i]),
                  .worst = quiet[i],
                  .worst_in_burst = {},
                  .worst_behind_services = {},
                  .worst_steady = steady[i]};
    set_limits(row, plan, next_sync(plan, sync_end));
    budget.rows.push_back(std::move(row));
  }
  return budget;
}

}  // namespace

std::optional<Time> BudgetRow::margin() const noexcept {
  if (!worst || frame.kind == Traffic::sync) return std::nullopt;
  std::optional<Time> left;
  if (why != BudgetLimit::none) left = limit - *worst;
  if (cycle != Time{0}) left = std::min(left.value_or(Time::max()), cycle - *worst);
  return left;
}

const BudgetRow* BusBudget::tightest() const noexcept {
  const BudgetRow* tightest = nullptr;
  for (const BudgetRow& row : rows) {
    const auto margin = row.margin();
    if (margin && (tightest == nullptr || *margin < *tightest->margin())) tightest = &row;
  }
  return tightest;
}

bool BusBudget::fits() const noexcept {
  return !refused && std::ranges::all_of(rows, &BudgetRow::fits);
}

bool BusBudget::fits_in_burst() const noexcept {
  return !refused && std::ranges::all_of(rows, &BudgetRow::fits_in_burst);
}

bool BusBudget::fits_but_for_changes() const noexcept {
  return fits() && std::ranges::any_of(rows, &BudgetRow::is_late_by_changes_only);
}

Time BusBudget::sync_delay() const noexcept {
  Time delay{};
  for (const auto& row : rows) {
    if (row.tolerance == Time{0} || !row.worst) continue;
    delay = std::max(delay, *row.worst - row.cycle);
  }
  return delay;
}

std::optional<Time> BusBudget::sync_delay_behind_services() const noexcept {
  const auto sync =
      std::ranges::find(rows, Traffic::sync, [](const BudgetRow& row) { return row.frame.kind; });
  if (sync == rows.end()) return Time{0};
  if (!sync->worst_behind_services || !sync->worst) return std::nullopt;
  return *sync->worst_behind_services - *sync->worst;
}

bool bus_fits(const BusPlan& plan, const BudgetOptions& options) {
  return judged(bus_traffic(plan, options), plan, options).fits();
}

BusBudget bus_budget(const BusPlan& plan, const BudgetOptions& options) {
  BusTraffic traffic = bus_traffic(plan, options);
  const Bounds burst = bounds(traffic, plan, options, {.emcys = Emcys::one_of_each});
  const Bounds queue = bounds(traffic, plan, options, {.services = Services::in_queue});
  BusBudget budget = judged(std::move(traffic), plan, options);
  for (std::size_t i = 0; i < budget.rows.size(); ++i) {
    budget.rows[i].worst_in_burst = burst[i];
    budget.rows[i].worst_behind_services = queue[i];
  }
  return budget;
}

std::optional<std::uint16_t> fitting_service_frames(const BusPlan& plan,
                                                    const BudgetOptions& options) {
  BusPlan tried = plan;
  const auto fits = [&](std::uint16_t frames) {
    tried.cycle.service_frames = frames;
    return bus_fits(tried, options);
  };
  if (!fits_period(plan)) return std::nullopt;
  std::uint16_t too_many = plan.cycle.service_frames;
  if (fits(too_many)) return too_many;
  std::uint16_t enough = 1;
  if (too_many <= enough || !fits(enough)) return std::nullopt;
  while (too_many - enough > 1) {
    const auto middle = static_cast<std::uint16_t>((enough + too_many) / 2);
    (fits(middle) ? enough : too_many) = middle;
  }
  return enough;
}

}  // namespace takt
