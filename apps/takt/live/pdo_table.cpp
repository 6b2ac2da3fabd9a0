#include "apps/takt/live/pdo_table.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <utility>

#include "apps/takt/live/screen.hpp"
#include "eds_parser/table/ids.hpp"

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
  if (pdo.output != 0) return pdo.stale != 0 ? "held back" : "";
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

std::string row(const pdo_state_t& pdo, const status_t& status) {
  const CobId id = pdo.extended != 0 ? CobId::extended(static_cast<std::uint32_t>(pdo.cob_id))
                                     : CobId::base(static_cast<std::uint32_t>(pdo.cob_id));
  std::string text = fmt::format(
      "{:>4}  {}  {:<16}{:<11}{:>4}{:>8}{:>7}{:>8}{:>8}{:>8}{:>8}{:>8}  {}", pdo.node_id,
      left(name_of(status, pdo.node_id), 16), label(pdo), to_string(id), pdo.transmission,
      pdo.count, pdo.toggle != 0 ? 1 : 0, pdo.age < 0 ? "-" : std::to_string(pdo.age), pdo.missing,
      pdo.late, pdo.too_short, pdo.too_long, state(pdo));
  while (text.back() == ' ') text.pop_back();
  return text;
}

}  // namespace

std::vector<std::string> pdo_lines(const pdo_status_t& pdos, const status_t& status) {
  std::vector<std::string> lines{
      "NODE  NAME              PDO             COB-ID     TYPE   COUNT TOGGLE     AGE MISSING    "
      "LATE   SHORT    LONG  IN THE NEWEST IMAGE"};
  for (const pdo_state_t& pdo : pdos.pdos) lines.push_back(row(pdo, status));
  return lines;
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
