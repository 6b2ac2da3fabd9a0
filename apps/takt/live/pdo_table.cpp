#include "apps/takt/live/pdo_table.hpp"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

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
  std::string text = (pdo.output != 0 ? "RPDO" : "TPDO") + std::to_string(pdo.number);
  if (pdo.header != 0) {
    const auto header = static_cast<std::uint32_t>(pdo.header);
    text += " " + to_string(ObjectKey{static_cast<std::uint16_t>(header >> 8),
                                      static_cast<std::uint8_t>(header >> 24)});
  }
  return text;
}

std::string state(const pdo_state_t& pdo) {
  if (pdo.output != 0) return pdo.stale != 0 ? "held back" : "";
  std::string text;
  const auto add = [&](bool on, const char* word) {
    if (on) text += (text.empty() ? "" : ", ") + std::string{word};
  };
  add((pdo.flags & arrived) != 0, "arrived");
  add((pdo.flags & missing) != 0, "missing");
  add((pdo.flags & late) != 0, "late");
  add((pdo.flags & too_short) != 0, "too short, ignored");
  add((pdo.flags & too_long) != 0, "too long");
  if (text.empty()) text = pdo.count == 0 ? "never seen" : pdo.stale != 0 ? "stale" : "";
  return text;
}

std::string row(const pdo_state_t& pdo, const status_t& status) {
  const CobId id = pdo.extended != 0 ? CobId::extended(static_cast<std::uint32_t>(pdo.cob_id))
                                     : CobId::base(static_cast<std::uint32_t>(pdo.cob_id));
  const auto count = [](std::int64_t value) { return right(std::to_string(value), 8); };
  std::string text = right(std::to_string(pdo.node_id), 4) + "  " +
                     left(name_of(status, pdo.node_id), 16) + "  " + left(label(pdo), 16) +
                     left(to_string(id), 11) + right(std::to_string(pdo.transmission), 4) +
                     count(pdo.count) + right(pdo.toggle != 0 ? "1" : "0", 7) +
                     right(pdo.age < 0 ? "-" : std::to_string(pdo.age), 8);
  text += count(pdo.missing) + count(pdo.late) + count(pdo.too_short) + count(pdo.too_long) + "  " +
          state(pdo);
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
