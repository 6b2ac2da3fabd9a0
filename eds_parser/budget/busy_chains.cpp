#include "eds_parser/budget/busy_chains.hpp"

namespace takt {
namespace {

constexpr int longest_chain = 32;  // length in cycles

}  // namespace

std::optional<Time> BusyChains::end_of(const Busy& busy) const {
  Time longest = busy.own;
  for (std::size_t k = 0; k < busy.at; ++k) longest = std::max(longest, frames_[k].frame);
  for (Time waited = busy.work;;) {
    const Time next = busy.work + from_devices(0, busy.at, busy.rounds, waited) +
                      behind_next_sync(busy, waited) +
                      error_time(waited + busy.own, options_.errors, bit_, longest);
    if (next <= waited) return busy.since + waited + busy.own;
    if (next > (longest_chain + 3) * plan_.cycle.period) return std::nullopt;
    waited = next;
  }
}

Time BusyChains::from_devices(std::size_t first, std::size_t end, int rounds, Time within) const {
  const Time all = by_themselves(first, end, within);
  if (rounds == 0) return all;
  Time too_many{};
  for (std::size_t k = first; k < end; ++k) {
    if (!frames_[k].is_answer() || frames_[k].period < plan_.cycle.period) continue;
    too_many += by_themselves(k, k + 1, within) - answers_in(rounds - 1) - late_answers();
  }
  return all - std::max(too_many, Time{0});
}

Time BusyChains::behind_next_sync(const Busy& busy, Time waited) const {
  // The master's own SYNC also waits for late outputs in the queue.
  if (!busy.input && (!busy.output || plan_.cycle.makes_sync())) return Time{0};
  const Time until = busy.since + waited + bit_ + sync_jitter_;
  Time sum{};
  if (busy.input && until > plan_.cycle.receive_window) sum += by_master(busy.at);
  for (std::size_t cycle = 0;; ++cycle) {
    const Time sync = static_cast<Time::rep>(cycle) * plan_.cycle.period;
    if (sync - origin() > until) return sum;
    if (cycle != 0) {
      sum += sync_frame() + inputs_before(busy.at, busy.input.value_or(any_cycle) + cycle);
      if (busy.output) sum += by_master(busy.at);
    }
    if (busy.input && sync + plan_.cycle.output_deadline <= until) {
      sum += outputs_before(busy.at, cycle);
    }
  }
}

BusyChains::Busy BusyChains::busy_since_outputs(std::size_t at, int cycles, bool services) const {
  const int inputs = cycles - (inputs_may_follow_outputs() ? 0 : 1);
  Busy busy{
      .at = at,
      .since = plan_.cycle.output_deadline - cycles * plan_.cycle.period + sync_jitter_,
      .work = outputs_blocking_ + cycles * (outputs_work_ + sync_frame()) + inputs * inputs_work_};
  if (services) {
    busy.since -= 2 * services_in(1);
    busy.work += services_in(cycles);
    busy.rounds = cycles + 1;
  } else if (services_count(at)) {
    busy.work += services_in(cycles - 1);
    busy.rounds = cycles;
  } else {
    busy.since += outputs_wait();
  }
  if (late_ == LateSync::follows_up) busy.work += follow_up(busy, cycles);
  return busy;
}

BusyChains::Busy BusyChains::busy_since_sync(std::size_t at, int cycles) const {
  Busy busy{.at = at, .since = -cycles * plan_.cycle.period};
  busy.work = sync_blocking() + sync_frame() + options_.device_time;
  if (late_ == LateSync::at_any_time) busy.work += std::max(sync_late() - sync_blocking(), Time{0});
  if (cycles == 0) return busy;
  busy.since += sync_jitter_;
  busy.work += gap_blocking() + cycles * (sync_frame() + inputs_work_ + outputs_work_);
  if (services_count(at)) {
    busy.work += 2 * services_behind_window() + services_in(cycles - 1);
    busy.rounds = cycles;
  }
  if (late_ == LateSync::follows_up) busy.work += follow_up(busy, cycles);
  return busy;
}

BusyChains::Busy BusyChains::busy_until_outputs(std::size_t at, int cycles) const {
  Busy busy = busy_since_outputs(at, cycles, true);
  const Time since = -cycles * plan_.cycle.period;
  busy.work += busy.since - since;
  busy.since = since;
  return busy;
}

Time BusyChains::follow_up(const Busy& busy, int cycles) const {
  const Time within = sync_late() - busy.since;
  const std::size_t lowest = lowest_queued();
  return cycles * options_.device_time + (cycles - 1) * gap_blocking() +
         from_devices(std::min(busy.at, lowest), lowest, busy.rounds, within);
}

std::optional<std::vector<BusyChains::Busy>> BusyChains::busy_before(std::size_t at) const {
  std::vector<Busy> all{busy_since_sync(at, 0)};
  for (int cycles = 1; cycles <= longest_chain; ++cycles) {
    const Busy outputs = busy_since_outputs(at, cycles, false);
    const Busy sync = busy_since_sync(at, cycles);
    all.push_back(outputs);
    all.push_back(sync);
    auto end = later(end_of(outputs), end_of(sync));
    if (services_count(at)) {
      for (const auto& busy :
           {busy_since_outputs(at, cycles, true), busy_until_outputs(at, cycles)}) {
        all.push_back(busy);
        end = later(end, end_of(busy));
      }
    }
    if (end && *end <= sync_frame()) return all;
  }
  return std::nullopt;
}

}  // namespace takt
