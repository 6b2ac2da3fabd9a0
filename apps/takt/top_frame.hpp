#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "apps/takt/screen.hpp"
#include "master/gateway/bus_view.hpp"

namespace takt {

struct TopOptions {
  std::size_t rows = 24;  ///< of the terminal; 0: as many as there is to tell
  std::size_t first_signal = 0;
};

struct TopFrame {
  std::vector<Line> lines;
  std::size_t first_signal = 0;  ///< that is shown: the wanted one or, near the end, an earlier one
};

/// What `takt top` shows of one bus. Messages have a place of their own, so the values stand still.
TopFrame top_frame(const BusView& bus, const TopOptions& options);

/// The line of a bus and the table of its nodes: shared with `takt status`.
std::vector<Line> status_lines(const BusView& bus);

std::string nmt_name(int state);                   ///< "operational"
std::string boot_name(const node_status_t& node);  ///< "ready", "step 4 of 31"
std::string stop_name(
    int stop);  ///< of status_t: "none", "under way", "confirmed", "not confirmed"
std::string bus_condition(int state);  ///< of diagnosis_t: "running", "offline"

}  // namespace takt
