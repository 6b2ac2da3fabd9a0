#include "eds_parser/print/budget_bars.hpp"

#include <algorithm>

#include "eds_parser/plan/frame_time.hpp"

namespace takt {
namespace {

Time ready_of(const BudgetRow& row, const BusPlan& plan) {
  if (row.frame.kind == Traffic::rpdo) return plan.cycle.output_deadline;
  if (row.frame.kind != Traffic::tpdo) return Time{0};
  const unsigned counter = plan.cycle.sync_overflow != 0 ? 1 : 0;
  return plan.cycle.makes_sync() ? wire_time(shortest_frame_bits(counter), plan.bitrate) : Time{0};
}

}  // namespace

double tick_step(double end, double most) {
  double step = 1;
  for (unsigned i = 0; end / step > most; ++i) step *= i % 3 == 1 ? 2.5 : 2;
  return step;
}

CyclePicture cycle_picture(const BusPlan& plan, const BusBudget& budget) {
  CyclePicture picture{.bars = {}, .marks = {}, .end = plan.cycle.period};
  for (const auto& row : budget.rows) {
    if (!row.frame.in_cycle || !row.worst) continue;
    picture.bars.push_back({.row = &row,
                            .ready = ready_of(row, plan),
                            .begin = *row.worst - row.frame.frame,
                            .end = *row.worst});
    picture.end = std::max(picture.end, *row.worst);
  }
  std::ranges::stable_sort(picture.bars, {}, [](const CycleBar& bar) { return bar.end; });
  picture.marks = {{"receive window ends", plan.cycle.receive_window},
                   {"outputs go out", plan.cycle.output_deadline},
                   {"next SYNC", plan.cycle.period}};
  if (plan.cycle.sync_window > Time{0})
    picture.marks.push_back({"SYNC window (0x1007) ends", plan.cycle.sync_window});
  std::ranges::stable_sort(picture.marks, {}, &CycleMark::at);
  return picture;
}

}  // namespace takt
