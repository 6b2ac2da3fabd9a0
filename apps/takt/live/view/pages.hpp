#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "apps/takt/live/text/table.hpp"
#include "master/gateway/message/bus_view.hpp"

namespace takt {

/// A page of `takt top`.
enum class Page : unsigned char { axes, words, io, pdos, timing, nodes };

/// The names of all pages, in their order.
inline constexpr std::array<std::string_view, 6> page_names{"axes", "words",  "io",
                                                            "pdos", "timing", "nodes"};

/// Returns the page with this name.
std::optional<Page> page_of(std::string_view name);

// Each function returns the text of one page. No line is longer than `width` columns, and no column
// is left out.

/// Returns one row for each axis, then one for each other node.
Table::Text axes_page(const BusView& bus, std::size_t width);
/// Returns the statuswords and controlwords of all axes, in hex and in words.
Table::Text words_page(const BusView& bus, std::size_t width);
/// Returns all values of the image, those of nodes without axes first, with the bits of digital
/// values.
Table::Text io_page(const BusView& bus, std::size_t width);
Table::Text pdos_page(const BusView& bus, std::size_t width);
Table::Text timing_page(const BusView& bus, std::size_t width);
Table::Text nodes_page(const BusView& bus, std::size_t width);

Table::Text page_text(Page page, const BusView& bus, std::size_t width);

}  // namespace takt
