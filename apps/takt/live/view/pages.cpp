#include "apps/takt/live/view/pages.hpp"

#include <algorithm>
#include <cstdint>
#include <fmt/format.h>
#include <set>
#include <utility>

#include "apps/takt/live/text/character_width.hpp"
#include "apps/takt/live/text/node_words.hpp"
#include "apps/takt/live/text/signal_text.hpp"
#include "apps/takt/live/view/axis_view.hpp"
#include "apps/takt/live/view/bus_lines.hpp"
#include "apps/takt/live/view/pdo_table.hpp"
#include "apps/takt/live/view/timing_table.hpp"
#include "master/lcm/printable_text.hpp"

namespace takt {
namespace {

Table::Text waiting(std::string_view text, std::size_t width) {
  return {.head = {}, .body = paragraph(text, Paint::dim, width, 2)};
}

Table axis_table(const std::vector<AxisView>& axes) {
  Table table{{{.title = "AXIS", .kind = Cell::name, .least = 6},
               {.title = "STATE", .kind = Cell::words, .least = 18, .usual = 18},
               {.title = "MODE"},
               {.title = "POSITION", .kind = Cell::number, .usual = 12},
               {.title = "VELOCITY", .kind = Cell::number, .usual = 12},
               {.title = "FOLLOWING", .kind = Cell::number, .usual = 10},
               {.title = "ERROR", .kind = Cell::words, .least = 5}}};
  for (const AxisView& axis : axes) {
    table.add({{axis.name, Paint::title},
               axis.state,
               {axis.mode},
               {quantity_text(axis.position, 11)},
               {quantity_text(axis.velocity, 8)},
               {quantity_text(axis.following_error, 7)},
               axis.error});
  }
  return table;
}

/// Returns the values of one direction of a node in short, for example "6000:01 2D".
std::string values_of(const BusView& bus, std::int16_t node, bool output) {
  std::string text;
  for (std::size_t i = 0; i < bus.values().size(); ++i) {
    const signal_t& signal = bus.signals()[i];
    if (signal.node_id != node || (signal.output != 0) != output) continue;
    if (!text.empty()) text += "  ";
    text += fmt::format("{:04X}:{:02X} {}", signal.index & 0xFFFF, signal.sub & 0xFF,
                        bus.stale(i) ? "stale" : short_value(signal, bus.values()[i]));
  }
  return text.empty() ? "-" : text;
}

Table other_table(const BusView& bus, const std::vector<const node_status_t*>& nodes) {
  Table table{{{.title = "NODE", .kind = Cell::name, .least = 6},
               {.title = "STATE", .kind = Cell::words, .least = 18, .usual = 18},
               {.title = "INPUTS", .kind = Cell::words, .least = 10},
               {.title = "OUTPUTS", .kind = Cell::words, .least = 10}}};
  for (const node_status_t* node : nodes) {
    const bool ready = boot_text(*node).text == "ready";
    table.add({{node->name, Paint::title},
               ready ? nmt_text(node->nmt_state) : boot_text(*node),
               {values_of(bus, node->node_id, false)},
               {values_of(bus, node->node_id, true)}});
  }
  return table;
}

/// The words of drives: the axis, the word with its value in hex, and its meaning, which may take
/// several lines. In a narrow terminal, these three are on separate lines.
class WordLines {
 public:
  WordLines(const std::vector<AxisView>& axes, std::size_t width) : width_{width} {
    name_columns_ = 4;
    for (const AxisView& axis : axes) {
      name_columns_ = std::max(name_columns_, columns_of(printable_text(axis.name)));
    }
    name_columns_ = std::min(name_columns_, width / 4);
    const std::string title = is_narrow() ? "AXIS" : left("AXIS", name_columns_);
    text_.head = {Line{}.add(title + (is_narrow() ? "" : "  WORD       MEANING"), Paint::dim)};
  }

  void add(const std::string& axis, std::string_view what, const std::optional<DriveWord>& word) {
    const std::string value = word ? fmt::format("{:04X}", word->value) : "-";
    const std::string meaning = word ? word->text : "not received";
    const std::string name = printable_text(axis);
    const std::string head = fmt::format("  {} {:<4}", what, value);
    if (is_narrow()) {
      if (!name.empty()) text_.body.push_back(Line{}.add(shortened(name, width_), Paint::title));
      text_.body.push_back(Line{}.add(head));
      for (const Line& line : paragraph(meaning, Paint::plain, width_ - 4, 0)) {
        text_.body.push_back(Line{}.add("    ").add(line.render(width_, false)));
      }
      return;
    }
    const std::string indent(name_columns_ + head.size() + 2, ' ');
    std::vector<Line> lines = paragraph(meaning, Paint::plain, width_ - indent.size(), 0);
    if (lines.empty()) lines.emplace_back();
    for (std::size_t i = 0; i < lines.size(); ++i) {
      Line line;
      if (i == 0) {
        line.add(left(shortened(name, name_columns_), name_columns_), Paint::title)
            .add(head + "  ");
      } else {
        line.add(indent);
      }
      text_.body.push_back(line.add(lines[i].render(width_, false)));
    }
  }
  Table::Text take() { return std::move(text_); }

 private:
  bool is_narrow() const { return width_ < narrow; }

  static constexpr std::size_t narrow = 40;

  std::size_t width_;
  std::size_t name_columns_ = 0;
  Table::Text text_;
};

/// Sorts the signals by node, those of nodes without axes first.
std::vector<std::size_t> by_node(const BusView& bus) {
  std::set<std::int16_t> with_axes;
  for (const AxisView& axis : axes_of(bus)) with_axes.insert(axis.node);
  std::vector<std::pair<bool, std::int16_t>> keys;
  for (const signal_t& signal : bus.signals()) {
    keys.emplace_back(with_axes.contains(signal.node_id), signal.node_id);
  }
  std::vector<std::size_t> order(keys.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::stable_sort(order, {}, [&](std::size_t at) { return keys[at]; });
  return order;
}

}  // namespace

std::optional<Page> page_of(std::string_view name) {
  const auto found = std::ranges::find(page_names, name);
  if (found == page_names.end()) return std::nullopt;
  return static_cast<Page>(found - page_names.begin());
}

Table::Text axes_page(const BusView& bus, std::size_t width) {
  if (bus.values().empty()) return waiting("waiting for the layout and an image ...", width);
  const std::vector<AxisView> axes = axes_of(bus);
  const std::vector<const node_status_t*> nodes = other_nodes(bus, axes);
  Table::Text text;
  if (!axes.empty()) text = axis_table(axes).text(width);
  if (nodes.empty()) return text;
  Table::Text others = other_table(bus, nodes).text(width);
  if (axes.empty()) return others;
  append(text.body, others.all());
  return text;
}

Table::Text words_page(const BusView& bus, std::size_t width) {
  if (bus.values().empty()) return waiting("waiting for the layout and an image ...", width);
  const std::vector<AxisView> axes = axes_of(bus);
  if (axes.empty()) return waiting("this bus has no axes", width);
  WordLines lines{axes, width};
  for (const AxisView& axis : axes) {
    lines.add(axis.name, "stat", axis.statusword);
    if (axis.controlword) lines.add("", "ctrl", axis.controlword);
  }
  return lines.take();
}

Table::Text io_page(const BusView& bus, std::size_t width) {
  if (bus.values().empty()) return waiting("waiting for the layout and an image ...", width);
  Table table{{{.title = "SIGNAL", .kind = Cell::name, .least = 16},
               {.title = "OBJECT"},
               {.title = "DIR"},
               {.title = "VALUE", .kind = Cell::number, .usual = 14},
               {.title = "RAW", .kind = Cell::number},
               {.title = ""}}};
  for (const std::size_t at : by_node(bus)) {
    const signal_t& signal = bus.signals()[at];
    const std::int64_t raw = bus.values()[at];
    const bool stale = bus.stale(at);
    table.add({{signal.node + "." + signal.name, stale ? Paint::bad : Paint::plain},
               {fmt::format("{:04X}:{:02X}", signal.index & 0xFFFF, signal.sub & 0xFF), Paint::dim},
               {signal.output != 0 ? "out" : "in", Paint::dim},
               {long_value(signal, raw)},
               {raw_text(signal, raw), Paint::dim},
               {stale ? "stale" : "", Paint::bad}});
  }
  return table.text(width);
}

Table::Text pdos_page(const BusView& bus, std::size_t width) {
  if (!bus.pdos()) return waiting("waiting for the PDOs ...", width);
  return pdo_table(*bus.pdos(), *bus.status(), width);
}

Table::Text timing_page(const BusView& bus, std::size_t width) {
  if (!bus.timing()) return waiting("waiting for the times of a second ...", width);
  Table::Text text{.head = {}, .body = timing_lines(*bus.timing(), width)};
  append(text.body, counter_lines(bus, width));
  return text;
}

Table::Text nodes_page(const BusView& bus, std::size_t width) {
  Table table{{{.title = "NODE", .kind = Cell::number},
               {.title = "NAME", .kind = Cell::name, .least = 6},
               {.title = "STATE", .kind = Cell::words, .least = 11},
               {.title = "BOOT"},
               {.title = "HEARTBEAT", .kind = Cell::number},
               {.title = "EMCY", .kind = Cell::number},
               {.title = "NO PDO", .kind = Cell::number},
               {.title = "HELD BY", .kind = Cell::name, .least = 7}}};
  for (const node_status_t& node : bus.status()->nodes) {
    const bool beats = node.heartbeat_age_ms >= 0;
    const bool errors = node.emcy_count != 0;
    table.add(
        {{std::to_string(node.node_id)},
         {node.name, Paint::title},
         nmt_text(node.nmt_state),
         {boot_name(node), boot_text(node).paint},
         {beats ? std::to_string(node.heartbeat_age_ms) + " ms" : "-"},
         {errors ? fmt::format("{} x {:04X}", node.emcy_count, node.last_emcy & 0xFFFF) : "-",
          errors ? Paint::bad : Paint::dim},
         {std::to_string(node.pdos_missing), node.pdos_missing == 0 ? Paint::dim : Paint::warning},
         {node.holder.empty() ? "-" : node.holder, Paint::dim}});
  }
  return table.text(width);
}

Table::Text page_text(Page page, const BusView& bus, std::size_t width) {
  static constexpr std::array pages{axes_page, words_page,  io_page,
                                    pdos_page, timing_page, nodes_page};
  static_assert(pages.size() == page_names.size());
  return pages[static_cast<std::size_t>(page)](bus, width);
}

}  // namespace takt
