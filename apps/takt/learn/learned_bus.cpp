#include "apps/takt/learn/learned_bus.hpp"

#include <algorithm>
#include <array>

#include "apps/takt/learn/learned_pdos.hpp"
#include "eds_parser/values/little_endian.hpp"

namespace takt::learn {
namespace {

/// Returns the boot with the most writes, the newest of equal ones. Returns null if there is no
/// boot.
const LearnedBoot* fullest(const std::vector<LearnedBoot>& boots) {
  const LearnedBoot* best = nullptr;
  for (const LearnedBoot& boot : boots) {
    if (best == nullptr || boot.writes.size() >= best->writes.size()) best = &boot;
  }
  return best;
}

}  // namespace

std::optional<std::uint64_t> LearnedValue::number() const noexcept {
  if (last.empty() || last.size() > 8) return {};
  return from_little_endian(std::as_bytes(std::span{last}));
}

std::optional<std::uint64_t> LearnedValues::number(ObjectKey key) const noexcept {
  const auto found = find(key);
  return found == end() ? std::nullopt : found->second.number();
}

std::optional<std::uint64_t> LearnedValues::number_read(ObjectKey key) const noexcept {
  const auto found = find(key);
  return found == end() || !found->second.read ? std::nullopt : found->second.number();
}

std::optional<std::uint64_t> LearnedValues::number_written(ObjectKey key) const noexcept {
  const auto found = find(key);
  return found == end() || !found->second.written ? std::nullopt : found->second.number();
}

std::vector<LearnedWrite> LearnedNode::configuration() const {
  const LearnedBoot* best = fullest(boots);
  if (best == nullptr) return {};
  std::vector<LearnedWrite> all = best->writes;
  for (const LearnedBoot& boot : boots) {
    if (&boot == best) continue;
    for (const LearnedWrite& write : boot.writes) {
      const auto same = [&](const LearnedWrite& other) {
        return other.transfer.object == write.transfer.object;
      };
      if (std::ranges::none_of(all, same)) all.push_back(write);
    }
  }
  return all;
}

LearnedValues LearnedNode::values() const {
  const LearnedBoot* best = fullest(boots);
  if (best == nullptr) return {};
  LearnedValues all = best->values;
  for (auto boot = boots.rbegin(); boot != boots.rend(); ++boot) {
    for (const auto& [key, value] : boot->values) all.try_emplace(key, value);
  }
  return all;
}

bool LearnedNode::is_there() const noexcept {
  return booted_up || answers != 0 || heartbeats.count() != 0 || addressed || guarded();
}

std::optional<std::uint8_t> LearnedBus::master() const {
  constexpr std::uint8_t usual = 127;
  std::vector<std::uint8_t> silent;  // nodes that send frames, but to which nobody sends
  for (const auto& [id, node] : nodes) {
    const bool reported =
        node.requests != 0 || node.answers != 0 || node.addressed || node.guarded();
    if (reported) continue;
    const bool lives =
        node.heartbeats.count() != 0 ||
        (node.booted_up && (node.ignores_reset || (id == usual && !sends_as_device(id))));
    if (lives) silent.push_back(id);
  }
  const auto watched = [&](std::uint8_t id) {
    return std::ranges::any_of(nodes, [&](const auto& entry) {
      const LearnedValues values = entry.second.values();
      return std::ranges::any_of(values, [&](const auto& object) {
        const auto number = object.second.number();
        return object.first.index == 0x1016 && object.first.sub != 0 && object.second.written &&
               number && (*number >> 16U & 0x7FU) == id;
      });
    });
  };
  const auto found = std::ranges::find_if(silent, watched);
  if (found != silent.end()) return *found;
  const bool served =
      std::ranges::any_of(nodes, [](const auto& entry) { return entry.second.answers != 0; });
  if (served && silent.size() == 1) return silent.front();
  if (std::ranges::find(silent, usual) != silent.end()) return usual;
  return {};
}

bool LearnedBus::is_there(const LearnedNode& node) const {
  return node.is_there() || sends_as_device(node.id);
}

bool LearnedBus::sends_as_device(std::uint8_t node_id) const {
  const auto is_sent = [&](unsigned function) {
    const CobId id = CobId::base(function + node_id);
    const auto found = traffic.find(id);
    if (found == traffic.end() || found->second.frames.count() == 0) return false;
    return std::ranges::none_of(nodes, [&](const auto& entry) {
      return std::ranges::any_of(learned_pdos(entry.second.values()), [&](const LearnedPdo& pdo) {
        return pdo.is_tpdo && pdo.identifier() == id;
      });
    });
  };
  constexpr std::array functions{0x080U, 0x180U, 0x280U, 0x380U, 0x480U};
  return std::ranges::any_of(functions, is_sent);
}

std::vector<const LearnedNode*> LearnedBus::devices() const {
  const auto own = master();
  std::vector<const LearnedNode*> list;
  for (const auto& [id, node] : nodes) {
    if (is_there(node) && (!own || id != *own)) list.push_back(&node);
  }
  return list;
}

std::vector<std::uint8_t> LearnedBus::strangers() const {
  std::vector<std::uint8_t> list;
  for (const auto& [id, node] : nodes) {
    if (!is_there(node)) list.push_back(id);
  }
  return list;
}

}  // namespace takt::learn
