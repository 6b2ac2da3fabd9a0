#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "apps/takt/live/screen.hpp"
#include "master/gateway/message/bus_view.hpp"

namespace takt {

struct TopOptions {
  std::size_t rows = 24;  ///< rows of the terminal; 0 means no limit
  std::size_t first_signal = 0;
};

struct TopFrame {
  std::vector<Line> lines;
  std::size_t first_signal = 0;  ///< first signal shown; near the end earlier than requested
};

/// Returns the screen of `takt top` for one bus. Messages have a reserved place, so that the values
/// do not move.
TopFrame top_frame(const BusView& bus, const TopOptions& options);

/// Returns the lines of a bus and the table of its nodes, for `takt top` and `takt status`.
std::vector<Line> status_lines(const BusView& bus);

std::string nmt_name(int state);                   ///< for example "operational"
std::string boot_name(const node_status_t& node);  ///< for example "ready" or "step 4 of 31"
std::string stop_name(
    int stop);  ///< name of status_t::stop: "none", "under way", "confirmed" or "not confirmed"
std::string bus_condition(int state);  ///< state in diagnosis_t, for example "running"

}  // namespace takt
