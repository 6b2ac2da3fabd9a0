#include "eds_parser/budget/cycle_bounds.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "eds_parser/budget/busy_chains.hpp"

namespace takt {
namespace {

constexpr int most_rounds = 16;

using Bounds = std::vector<std::optional<Time>>;

class CycleAnalysis : BusyChains {
 public:
  CycleAnalysis(const BusTraffic& traffic, const BusPlan& plan, const BudgetOptions& options,
                OtherTraffic other_traffic)
      : BusyChains{traffic, plan, options, other_traffic}, bounds_(frames_.size()) {}

  CycleBounds run() {
    if (is_overloaded()) return {.ends = std::move(bounds_)};
    if (!find_sync_jitter() || !find_outputs()) return {.ends = Bounds(frames_.size())};
    bound_sync();
    bound_inputs();
    return {.ends = std::move(bounds_), .outputs_wait = outputs_wait()};
  }

 private:
  /// Computes the latest end of SYNC. Outputs delay SYNC, because all frames of the master leave
  /// one queue.
  void bound_sync() {
    if (!sync_) return;
    const Time longest = frames_[*sync_].frame;
    const Time relieved = sync_blocking() - sync_blocking_;
    bounds_[*sync_] =
        later(end_of({.at = *sync_, .work = sync_blocking(), .own = longest}),
              end_of({.at = *sync_, .since = sync_late(), .work = relieved, .own = longest}));
  }

  void bound_inputs() {
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      if (!frames_[i].is_input()) continue;
      std::optional<Time> worst{Time{0}};
      for (std::size_t cycle = 0; cycle < turns() && worst; ++cycle) {
        if (!has_turn(frames_[i], cycle)) continue;
        worst = later(worst, input_end(i, cycle));
      }
      bounds_[i] = worst;
    }
  }

  /// Returns the latest end of one TPDO. TPDOs follow SYNC, so each TPDO of higher priority goes
  /// before this one once.
  std::optional<Time> input_end(std::size_t at, std::size_t cycle) const {
    const auto& own = frames_[at];
    const auto chains = busy_before(at);
    if (!chains) return std::nullopt;
    Time others = (own.burst - 1) * own.frame + begun_before_input(at, cycle);
    if (!own.awaited) others += by_master(at);
    others += inputs_before(at, cycle);
    std::optional<Time> end{Time{0}};
    for (auto busy : *chains) {
      busy.work += others;
      busy.own = own.frame;
      busy.since -= origin();
      busy.input = cycle;
      end = later(end, end_of(busy));
    }
    return end;
  }

  /// Returns the bus time of the frame that may have begun before the TPDO is ready. It is either a
  /// frame of lower priority that began while the device computed, or the service frame that the
  /// master sends right behind SYNC when slow servers or full cycles have left no room for a long
  /// time.
  Time begun_before_input(std::size_t at, std::size_t cycle) const {
    Time begun{};
    for (std::size_t k = 0; k < at; ++k) {
      if (frames_[k].is_service()) begun = std::max(begun, frames_[k].frame);
    }
    if (options_.device_time == Time{0}) return begun;
    const Time lower = blocking(at, [&](const TrafficFrame& other) {
      if (other.is_input()) return has_turn(other, cycle);
      return comes_by_itself(other) || other.kind == Traffic::sdo;
    });
    return std::max(begun, lower);
  }

  /// Finds the jitter of another device's SYNC. The analysis cannot distinguish a SYNC that waits
  /// for the bus from one that was queued later, so the time to the previous SYNC and to the next
  /// one may be shorter by this wait. Returns false if the wait has no bound.
  bool find_sync_jitter() {
    if (!sync_ || plan_.cycle.makes_sync()) return true;
    const auto wait = end_of({.at = *sync_, .work = sync_blocking()});
    sync_jitter_ = wait.value_or(Time{0});
    return wait.has_value();
  }

  /// Computes the latest ends of the outputs. Returns false if they have no bound.
  bool find_outputs() {
    for (const auto late : {LateSync::in_time, LateSync::follows_up, LateSync::at_any_time}) {
      late_ = late;
      outputs_end_ = services_end_ = late_input_ = Time{0};
      if (settle_outputs()) return true;
    }
    return false;
  }

  /// Iterates, because the outputs may delay SYNC, and a late SYNC delays the outputs of the next
  /// cycle.
  bool settle_outputs() {
    for (int round = 0; round < most_rounds; ++round) {
      const std::tuple before{outputs_end_, services_end_, late_input_};
      find_late_inputs();
      if (services_in_queue()) before_queue_ = busy_before(lowest_queued());
      if (!bound_services() || !bound_outputs()) return false;
      if (late_ == LateSync::in_time && sync_late() > Time{0}) return false;
      if (before == std::tuple{outputs_end_, services_end_, late_input_}) return true;
    }
    return false;
  }

  /// Computes the latest end of the service frames that are in the queue before the outputs.
  bool bound_services() {
    if (!services_in_queue()) return true;
    const auto end = end_in_queue(Time{0}, Time{0});
    if (!end) return false;
    services_end_ = std::max(services_end_, *end);
    return services_end_ <= plan_.cycle.period + plan_.cycle.output_deadline;
  }

  /// Returns the end of an output that is sent after the service frames of its cycle, or the end of
  /// these frames if `before` and `own` are 0. The service frames and their answers would end
  /// before the outputs if devices sent no other frames outside the cycle during this time.
  std::optional<Time> end_in_queue(Time before, Time own) const {
    const std::size_t at = lowest_queued();
    const Time inputs = inputs_around(at);
    if (!before_queue_) return std::nullopt;
    const Time services = services_in(1);
    const Time begun = inputs_may_follow_outputs() ? inputs : begun_before_output(at);
    std::optional<Time> end = end_of({.at = at,
                                      .since = plan_.cycle.output_deadline - 2 * services,
                                      .work = before + services + begun,
                                      .own = own,
                                      .output = true,
                                      .rounds = 2});
    for (auto busy : *before_queue_) {
      busy.own = own;
      busy.output = true;
      busy.since -= origin();
      const int rounds = std::max(busy.rounds, 1);
      busy.rounds = rounds + 1;
      Busy all = busy;
      all.work += inputs + before + services;
      Busy behind_window = busy;
      behind_window.work += inputs + before + 2 * services_behind_window();
      behind_window.rounds = rounds;
      Busy until_outputs = busy;
      until_outputs.work = plan_.cycle.output_deadline - busy.since - answers_in(1) + before;
      const auto in_time =
          has_room_for_services() ? sooner(end_of(all), end_of(until_outputs)) : end_of(all);
      end = later(end, later(end_of(behind_window), in_time));
    }
    return end;
  }

  /// Computes the latest end of each output. The master sends the outputs at the output deadline
  /// from one queue in the order of their identifiers. Frames with priority over the lowest output
  /// sent so far may come between.
  bool bound_outputs() {
    Time before{};
    std::size_t lowest = 0;
    for (const std::size_t i : queue_) {
      lowest = std::max(lowest, i);
      before += (frames_[i].burst - 1) * frames_[i].frame;
      bounds_[i] = output_end(lowest, before, frames_[i].frame);
      before += frames_[i].frame;
      if (!bounds_[i]) return false;
      outputs_end_ = std::max(outputs_end_, *bounds_[i]);
    }
    // If the outputs of a cycle were still in the queue when those of the next cycle are queued,
    // the latter would wait for all frames that have priority over the former. Such a bus has no
    // bound.
    return outputs_end_ <= plan_.cycle.period + plan_.cycle.output_deadline;
  }

  std::optional<Time> output_end(std::size_t lowest, Time before, Time own) const {
    const Time inputs = inputs_around(lowest);
    auto end = end_of(
        {.at = lowest,
         .since = plan_.cycle.output_deadline,
         .work = before + (inputs_may_follow_outputs() ? inputs : begun_before_output(lowest)),
         .own = own,
         .output = true});
    if (services_in_queue()) return later(end, end_in_queue(before, own));
    const auto chains = busy_before(lowest);
    if (!chains) return std::nullopt;
    for (auto busy : *chains) {
      busy.work += inputs + before;
      busy.own = own;
      busy.output = true;
      busy.since -= origin();
      end = later(end, end_of(busy));
    }
    return end;
  }

  Time begun_before_output(std::size_t lowest) const {
    const Time begun =
        blocking(lowest, [this](const TrafficFrame& other) { return comes_by_itself(other); });
    return std::max(begun, longest_late_input(lowest));
  }

  /// Finds the TPDOs that may end after the output deadline, and the longest TPDO that may end
  /// after the next SYNC is due.
  void find_late_inputs() {
    late_inputs_.assign(frames_.size(), false);
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      if (!frames_[i].is_input()) continue;
      const auto end = input_end(i, any_cycle);
      late_inputs_[i] = !end || *end > plan_.cycle.output_deadline;
      if (!end || *end > plan_.cycle.period) late_input_ = std::max(late_input_, frames_[i].frame);
    }
  }

  Time longest_late_input(std::size_t lowest) const {
    Time longest{};
    for (std::size_t k = lowest + 1; k < frames_.size(); ++k) {
      if (late_inputs_[k]) longest = std::max(longest, frames_[k].frame);
    }
    return longest;
  }

  /// Returns the bus time of the frames of devices that may delay an output: those of its cycle
  /// with higher priority, and the longest one of lower priority that has just begun.
  Time inputs_around(std::size_t lowest) const {
    return inputs_before(lowest, any_cycle) + blocking(lowest, [this](const TrafficFrame& other) {
             return comes_by_itself(other) || other.is_input();
           });
  }

  std::vector<std::optional<Time>> bounds_;
  std::vector<bool> late_inputs_;                  ///< TPDOs that may end after the output deadline
  std::optional<std::vector<Busy>> before_queue_;  ///< busy periods of the current round
};

}  // namespace

CycleBounds cycle_bounds(const BusTraffic& traffic, const BusPlan& plan,
                         const BudgetOptions& options, OtherTraffic other_traffic) {
  return CycleAnalysis{traffic, plan, options, other_traffic}.run();
}

}  // namespace takt
