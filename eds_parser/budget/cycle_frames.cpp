#include "eds_parser/budget/cycle_frames.hpp"

#include <numeric>

#include "eds_parser/budget/service_traffic.hpp"
#include "eds_parser/plan/frame_time.hpp"

namespace takt {

CycleFrames::CycleFrames(const BusTraffic& traffic, const BusPlan& plan,
                         const BudgetOptions& options, OtherTraffic other_traffic)
    : frames_{traffic.frames},
      plan_{plan},
      options_{options},
      other_traffic_{other_traffic},
      bit_{wire_time(1, plan.bitrate)} {
  count_turns();
  find_ends_of_cycle();
}

void CycleFrames::find_ends_of_cycle() {
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    const auto& frame = frames_[i];
    const Time work = frame.burst * frame.frame;
    if (frame.kind == Traffic::sync) sync_ = i;
    if (frame.is_input()) inputs_work_ += work;
    if (frame.is_output()) {
      outputs_work_ += work;
      queue_.push_back(i);
      lowest_output_ = i;
    }
    if (!frame.is_service()) continue;
    services_work_ += work;
    longest_service_ = std::max(longest_service_, frame.frame);
    lowest_service_ = i;
  }
  std::ranges::stable_sort(queue_, {}, [this](std::size_t i) { return frames_[i].cob_id; });
  const auto by_itself = [this](const TrafficFrame& other) { return comes_by_itself(other); };
  // The SYNC of another device may come while late frames of the cycle before are still being sent.
  const auto meets_sync = [&](const TrafficFrame& other) {
    return by_itself(other) || (other.in_cycle && !plan_.cycle.makes_sync());
  };
  if (sync_) sync_blocking_ = blocking(*sync_, meets_sync);
  if (sync_) services_before_sync_ = by_master(*sync_);
  outputs_blocking_ = blocking(lowest_output_, by_itself);
  queue_blocking_ = blocking(std::max(lowest_output_, lowest_service_), by_itself);
}

bool CycleFrames::is_overloaded() const noexcept {
  const auto share = [](Time part, Time whole) {
    return static_cast<double>(part.count()) / static_cast<double>(whole.count());
  };
  double sum = share(sync_frame() + inputs_work_ + outputs_work_, plan_.cycle.period);
  for (std::size_t k = 0; k < lowest_output_; ++k) {
    const auto& frame = frames_[k];
    if (comes_by_itself(frame)) sum += share(frame.burst * frame.frame, frame.period);
  }
  return sum >= 1.0;
}

void CycleFrames::count_turns() {
  std::size_t turns = 1;
  for (const auto& frame : frames_) {
    if (frame.turn) turns = std::lcm(turns, std::size_t{frame.every});
    if (turns > most_turns) break;
  }
  turns_ = turns;
}

bool CycleFrames::has_turn(const TrafficFrame& frame, std::size_t cycle) const noexcept {
  return turns_ > most_turns || cycle >= any_cycle || !frame.turn ||
         cycle % frame.every == *frame.turn;
}

Time CycleFrames::by_themselves(std::size_t first, std::size_t end, Time within) const {
  Time sum{};
  for (std::size_t k = first; k < end; ++k) {
    const auto& other = frames_[k];
    if (!comes_by_itself(other)) continue;
    const auto times =
        ((within + bit_ + other.jitter).count() + other.period.count() - 1) / other.period.count();
    sum += times * other.burst * other.frame;
  }
  return sum;
}

Time CycleFrames::room_for_services() const noexcept {
  const Time inputs = sync_frame() + inputs_work_;
  const Time from = std::min(inputs, plan_.cycle.receive_window);
  return std::max((plan_.cycle.output_deadline - from) / 2, Time{0});
}

Time CycleFrames::services_in(int cycles) const noexcept {
  if (has_room_for_services()) return std::min(services_due(cycles), cycles * room_for_services());
  return (cycles + cycles_to_relief - 1) / cycles_to_relief * longest_service_;
}

/// A frame whose period is at least one cycle counts at most once in each cycle: it comes once at
/// any time, and then once in each period. A frame with a shorter period counts several times in a
/// cycle.
Time CycleFrames::services_due(int cycles) const noexcept {
  Time sum{};
  for (const auto& frame : frames_) {
    if (!frame.is_service()) continue;
    const auto periods = 2 + (cycles - 1) * plan_.cycle.period / frame.period;
    const bool often = frame.period < plan_.cycle.period;
    const auto times =
        often ? cycles * (plan_.cycle.period / frame.period) : std::min<Time::rep>(periods, cycles);
    sum += times * (frame.burst * frame.frame);
  }
  return sum;
}

Time CycleFrames::services_behind_window() const noexcept {
  const Time room = (plan_.cycle.output_deadline - plan_.cycle.receive_window) / 2;
  return std::min(services_in(1), std::max(room, Time{0}));
}

Time CycleFrames::late_answers() const noexcept {
  Time sum{};
  for (const auto& frame : frames_) {
    const auto nodes = std::min<std::size_t>(frame.burst, plan_.nodes.size());
    if (frame.is_answer()) sum += static_cast<Time::rep>(nodes) * frame.frame;
  }
  return sum;
}

Time CycleFrames::outputs_before(std::size_t at, std::size_t cycles_later) const {
  constexpr auto output = &TrafficFrame::is_output;
  return work_before(at, output) + (cycles_later == 0 ? blocking(at, output) : Time{0});
}

}  // namespace takt
