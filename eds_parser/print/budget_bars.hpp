#pragma once
#include <optional>
#include <string_view>
#include <vector>

#include "eds_parser/budget/budget.hpp"
#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// A frame of the cycle in a picture. Times count from SYNC.
struct CycleBar {
  const BudgetRow* row = nullptr;
  Time ready{};  ///< earliest time at which the frame may be on the wire
  Time begin{};  ///< begin of the frame if the frame is as late as possible
  Time end{};
};

/// A marked point in time of the cycle.
struct CycleMark {
  std::string_view text;
  Time at{};
};

/// The content of a picture of one cycle, sorted by the latest ends of the frames.
struct CyclePicture {
  std::vector<CycleBar> bars;
  std::vector<CycleMark> marks;
  /// End of the picture: the next SYNC, or the end of the latest frame if that is later.
  Time end{};
};

/// Returns 1, 2 or 5 times a power of ten, so that an axis up to `end` has at most `most` ticks.
double tick_step(double end, double most);

/// Returns no bars if there is no SYNC. Frames without a bound have no bar.
CyclePicture cycle_picture(const BusPlan& plan, const BusBudget& budget);

}  // namespace takt
