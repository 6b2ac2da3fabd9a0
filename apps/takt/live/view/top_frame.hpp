#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "apps/takt/live/text/line.hpp"
#include "apps/takt/live/view/pages.hpp"
#include "master/gateway/message/bus_view.hpp"

namespace takt {

struct TopOptions {
  Page page = Page::axes;
  std::size_t columns = 80;   ///< columns of the terminal
  std::size_t rows = 24;      ///< rows of the terminal; 0 means no limit
  std::size_t first_row = 0;  ///< first row of the page to show, for scrolling
  /// Events up to this time, in microseconds since 1970, are acknowledged and not shown.
  std::int64_t seen_until = 0;
};

struct TopFrame {
  std::vector<Line> lines;
  std::size_t first_row = 0;  ///< first row shown; near the end earlier than requested
};

/// Returns the screen of `takt top` for one bus. Messages have a reserved place, so that the values
/// do not move. Without a limit of rows, the page of the axes also has the words of their drives.
TopFrame top_frame(const BusView& bus, const TopOptions& options);

/// Returns the lines of `takt status`: the bus, its nodes, and the words of its drives if an image
/// has come.
std::vector<Line> status_lines(const BusView& bus, std::size_t width);

}  // namespace takt
