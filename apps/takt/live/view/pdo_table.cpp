#include "apps/takt/live/view/pdo_table.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <utility>

#include "eds_parser/values/ids.hpp"

namespace takt {
namespace {

constexpr int arrived = 1;
constexpr int missing = 2;
constexpr int late = 4;
constexpr int too_short = 8;
constexpr int too_long = 16;

std::string name_of(const status_t& status, std::int16_t node) {
  const auto found = std::ranges::find(status.nodes, node, &node_status_t::node_id);
  return found == status.nodes.end() ? std::string{} : found->name;
}

std::string label(const pdo_state_t& pdo) {
  const std::string text = fmt::format("{}PDO{}", pdo.output != 0 ? 'R' : 'T', pdo.number);
  if (pdo.header == 0) return text;
  const auto header = static_cast<std::uint32_t>(pdo.header);
  return text + " " +
         to_string(ObjectKey{static_cast<std::uint16_t>(header >> 8),
                             static_cast<std::uint8_t>(header >> 24)});
}

std::string state(const pdo_state_t& pdo) {
  if (pdo.output != 0) return pdo.stale != 0 ? "held back" : pdo.count == 0 ? "never sent" : "";
  static constexpr std::pair<int, const char*> words[]{{arrived, "arrived"},
                                                       {missing, "missing"},
                                                       {late, "late"},
                                                       {too_short, "too short, ignored"},
                                                       {too_long, "too long"}};
  std::string text;
  for (const auto& [flag, word] : words) {
    if ((pdo.flags & flag) != 0) text += (text.empty() ? "" : ", ") + std::string{word};
  }
  if (text.empty()) text = pdo.count == 0 ? "never seen" : pdo.stale != 0 ? "stale" : "";
  return text;
}

Paint state_paint(const pdo_state_t& pdo) {
  if (pdo.stale != 0) return Paint::bad;
  return (pdo.flags & (missing | late | too_short | too_long)) != 0 ? Paint::warning : Paint::plain;
}

PaintedText fault_count(std::int64_t count) {
  return {std::to_string(count), count == 0 ? Paint::dim : Paint::warning};
}

std::vector<PaintedText> row(const pdo_state_t& pdo, const status_t& status) {
  const CobId id = pdo.extended != 0 ? CobId::extended(static_cast<std::uint32_t>(pdo.cob_id))
                                     : CobId::base(static_cast<std::uint32_t>(pdo.cob_id));
  return {{std::to_string(pdo.node_id)},
          {name_of(status, pdo.node_id), Paint::title},
          {label(pdo)},
          {to_string(id)},
          {std::to_string(pdo.transmission)},
          {std::to_string(pdo.count)},
          {pdo.toggle != 0 ? "1" : "0"},
          {pdo.age < 0 ? "-" : std::to_string(pdo.age)},
          fault_count(pdo.missing),
          fault_count(pdo.late),
          fault_count(pdo.too_short),
          fault_count(pdo.too_long),
          {state(pdo), state_paint(pdo)}};
}

}  // namespace

Table::Text pdo_table(const pdo_status_t& pdos, const status_t& status, std::size_t width) {
  Table table{{{.title = "NODE", .kind = Cell::number},
               {.title = "NAME", .kind = Cell::name, .least = 6},
               {.title = "PDO"},
               {.title = "COB-ID"},
               {.title = "TYPE", .kind = Cell::number},
               {.title = "COUNT", .kind = Cell::number},
               {.title = "TGL", .kind = Cell::number},
               {.title = "AGE", .kind = Cell::number},
               {.title = "MISSED", .kind = Cell::number},
               {.title = "LATE", .kind = Cell::number},
               {.title = "SHORT", .kind = Cell::number},
               {.title = "LONG", .kind = Cell::number},
               {.title = "NOW", .kind = Cell::words, .least = 8}}};
  for (const pdo_state_t& pdo : pdos.pdos) table.add(row(pdo, status));
  return table.text(width);
}

nlohmann::json pdos_json(const pdo_status_t& pdos) {
  nlohmann::json list = nlohmann::json::array();
  for (const pdo_state_t& pdo : pdos.pdos) {
    list.push_back({{"node_id", pdo.node_id},
                    {"pdo", label(pdo)},
                    {"number", pdo.number},
                    {"direction", pdo.output != 0 ? "rpdo" : "tpdo"},
                    {"cob_id", pdo.cob_id},
                    {"extended", pdo.extended != 0},
                    {"transmission_type", pdo.transmission},
                    {"count", pdo.count},
                    {"toggle", pdo.toggle != 0},
                    {"age_cycles", pdo.age},
                    {"stale", pdo.stale != 0},
                    {"arrived", (pdo.flags & arrived) != 0},
                    {"missing_now", (pdo.flags & missing) != 0},
                    {"late_now", (pdo.flags & late) != 0},
                    {"missing", pdo.missing},
                    {"late", pdo.late},
                    {"too_short", pdo.too_short},
                    {"too_long", pdo.too_long}});
  }
  return list;
}

}  // namespace takt
