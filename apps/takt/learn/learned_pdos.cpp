#include "apps/takt/learn/learned_pdos.hpp"

#include <set>

namespace takt::learn {
namespace {

template <class T>
std::optional<T> at(const LearnedValues& values, ObjectKey key) {
  const auto number = values.number(key);
  return number ? std::optional{static_cast<T>(*number)} : std::nullopt;
}

/// Returns all entries of a mapping, or std::nullopt if one is missing. An incomplete mapping can't
/// be used.
std::optional<std::vector<std::uint32_t>> entries(const LearnedValues& values, std::uint16_t index,
                                                  std::uint8_t count) {
  std::vector<std::uint32_t> list;
  for (std::uint8_t sub = 1; sub <= count; ++sub) {
    const auto entry = at<std::uint32_t>(values, {index, sub});
    const std::uint32_t bits = entry.value_or(0) & 0xFFU;
    if (bits == 0 || bits > 64) return {};
    list.push_back(*entry);
  }
  return list;
}

LearnedPdo pdo_of(const LearnedValues& values, PdoNumber number) {
  LearnedPdo pdo{number};
  const std::uint16_t communication = pdo.communication_index();
  pdo.cob_id = at<std::uint32_t>(values, {communication, 1});
  pdo.transmission = at<std::uint8_t>(values, {communication, 2});
  pdo.inhibit_time = at<std::uint16_t>(values, {communication, 3});
  pdo.timer = at<std::uint16_t>(values, {communication, 5});
  pdo.sync_start = at<std::uint8_t>(values, {communication, 6});
  pdo.count = at<std::uint8_t>(values, {pdo.mapping_index(), 0});
  if (pdo.count && *pdo.count != 0 && *pdo.count <= 64) {
    pdo.mapping = entries(values, pdo.mapping_index(), *pdo.count);
  }
  return pdo;
}

}  // namespace

std::optional<CobId> LearnedPdo::identifier() const noexcept {
  return cob_id ? std::optional{CobId::of_object(*cob_id)} : std::nullopt;
}

std::vector<LearnedPdo> learned_pdos(const LearnedValues& values) {
  std::set<std::pair<bool, std::uint16_t>> seen;
  for (auto at = values.lower_bound({0x1400, 0}); at != values.end(); ++at) {
    const std::uint16_t index = at->first.index;
    if (!is_pdo_parameter(index)) break;
    seen.emplace(index >= 0x1800, static_cast<std::uint16_t>((index & 0x1FFU) + 1));
  }
  std::vector<LearnedPdo> pdos;
  for (const auto& [is_tpdo, number] : seen) pdos.push_back(pdo_of(values, {number, is_tpdo}));
  return pdos;
}

}  // namespace takt::learn
