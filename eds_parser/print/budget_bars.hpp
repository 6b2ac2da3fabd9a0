#pragma once
#include <optional>
#include <string_view>
#include <vector>

#include "eds_parser/budget/budget.hpp"
#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// A frame of the cycle in a picture, times after SYNC.
struct CycleBar {
  const BudgetRow* row = nullptr;
  Time ready{};  ///< from here on it may be on the wire
  Time begin{};  ///< of the frame, if it comes as late as it can
  Time end{};

  /// What is left of its limit, or until the next SYNC; none: it has neither.
  std::optional<Time> margin() const noexcept;
};

/// A moment of the cycle.
struct CycleMark {
  std::string_view text;
  Time at{};
};

/// What a picture of one cycle shows, in the order of its latest ends.
struct CyclePicture {
  std::vector<CycleBar> bars;
  std::vector<CycleMark> marks;
  Time end{};  ///< of the picture: the next SYNC, or the latest frame behind it
};

/// No bars: there is no SYNC. Frames without a bound have none.
CyclePicture cycle_picture(const BusPlan& plan, const BusBudget& budget);

}  // namespace takt
