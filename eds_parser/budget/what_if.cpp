#include "eds_parser/budget/what_if.hpp"

#include <algorithm>
#include <charconv>
#include <iterator>

namespace takt {
namespace {

constexpr std::uint32_t shortest_period_us = 200;
constexpr std::uint32_t longest_period_us = 60'000'000;

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(' ');
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(' ') - first + 1);
}

template <class T>
std::optional<T> number(std::string_view text, T least, T most) {
  const bool hex = text.starts_with("0x");
  if (hex) text.remove_prefix(2);
  T value{};
  const auto* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value, hex ? 16 : 10);
  const bool good = error == std::errc{} && stop == end && value >= least && value <= most;
  return good ? std::optional{value} : std::nullopt;
}

/// Reads a time such as "1500us", "2ms" or "1s".
std::optional<std::uint32_t> microseconds(std::string_view text) {
  const auto unit = text.find_first_not_of("0123456789");
  if (unit == std::string_view::npos) return std::nullopt;
  const auto count = number<std::uint32_t>(text.substr(0, unit), 1, longest_period_us);
  const auto name = text.substr(unit);
  const std::uint64_t factor = name == "us" ? 1 : name == "ms" ? 1000 : name == "s" ? 1'000'000 : 0;
  if (!count || factor == 0 || *count * factor > longest_period_us) return std::nullopt;
  return static_cast<std::uint32_t>(*count * factor);
}

PdoChange& change_of(WhatIf& changes, PdoChange pdo) {
  const auto same = std::ranges::find_if(changes.pdos, [&](const PdoChange& other) {
    return other.node == pdo.node && other.tpdo == pdo.tpdo && other.number == pdo.number;
  });
  return same != changes.pdos.end() ? *same : changes.pdos.emplace_back(std::move(pdo));
}

/// Whether a transmission type is reserved. CiA 301, tables 69 and 72.
bool is_reserved(std::uint8_t transmission, bool tpdo) {
  return transmission > 240 && transmission < (tpdo ? 252 : 254);
}

bool set_pdo(std::string_view what, std::string_view value, PdoChange& pdo) {
  if (what.empty() && value == "off") {
    pdo.off = true;
    return true;
  }
  if (what.empty()) {
    pdo.transmission = number<std::uint8_t>(value, 0, 255);
    return pdo.transmission && !is_reserved(*pdo.transmission, pdo.tpdo);
  }
  if (what == "start") {
    pdo.sync_start = number<std::uint8_t>(value, 0, 240);
    return pdo.sync_start.has_value();
  }
  if (what == "cob_id") {
    pdo.cob_id = number<std::uint32_t>(value, 1, 0x1FFF'FFFF);
    return pdo.cob_id.has_value();
  }
  const auto us = what == "inhibit" ? microseconds(value) : std::nullopt;
  if (!us || *us % 100 != 0 || *us / 100 > 0xFFFF) return false;
  pdo.inhibit_time = static_cast<std::uint16_t>(*us / 100);
  return true;
}

/// Reads a key such as `elbow.tpdo2` or `elbow.tpdo2.start`.
bool add_pdo_change(std::string_view key, std::string_view value, WhatIf& changes) {
  for (const std::string_view kind : {".tpdo", ".rpdo"}) {
    const auto at = key.rfind(kind);
    if (at == std::string_view::npos || at == 0) continue;
    const auto rest = key.substr(at + kind.size());
    const auto dot = rest.find('.');
    const auto index = number<std::uint16_t>(rest.substr(0, dot), 1, 512);
    if (!index) return false;
    const auto what = dot == std::string_view::npos ? "" : rest.substr(dot + 1);
    return set_pdo(what, value,
                   change_of(changes, {.node = std::string{key.substr(0, at)},
                                       .tpdo = kind == ".tpdo",
                                       .number = *index}));
  }
  return false;
}

std::string time_text(std::uint64_t us) {
  return us % 1000 == 0 ? std::to_string(us / 1000) + "ms" : std::to_string(us) + "us";
}

void append(std::string& text, const std::string& change) {
  if (!text.empty()) text += ',';
  text += change;
}

void append(std::string& text, const PdoChange& pdo) {
  const std::string name = pdo.node + (pdo.tpdo ? ".tpdo" : ".rpdo") + std::to_string(pdo.number);
  if (pdo.off) append(text, name + "=off");
  if (pdo.transmission) append(text, name + '=' + std::to_string(*pdo.transmission));
  if (pdo.sync_start) append(text, name + ".start=" + std::to_string(*pdo.sync_start));
  if (pdo.inhibit_time) append(text, name + ".inhibit=" + time_text(*pdo.inhibit_time * 100U));
  if (pdo.cob_id) {
    constexpr char digits[] = "0123456789ABCDEF";
    std::string hex;
    for (std::uint32_t id = *pdo.cob_id; id != 0; id >>= 4) hex.insert(0, 1, digits[id & 0xF]);
    append(text, name + ".cob_id=0x" + hex);
  }
}

}  // namespace

bool add_change(std::string_view text, WhatIf& changes) {
  const auto equals = text.find('=');
  if (equals == std::string_view::npos) return false;
  const auto key = trimmed(text.substr(0, equals));
  const auto value = trimmed(text.substr(equals + 1));
  if (key == "period") {
    changes.sync_period_us = microseconds(value);
    return changes.sync_period_us && *changes.sync_period_us >= shortest_period_us;
  }
  if (key == "bitrate") {
    changes.bitrate_kbit = number<std::uint16_t>(value, 10, 1000);
    return changes.bitrate_kbit &&
           std::ranges::find(known_bitrates, *changes.bitrate_kbit) != std::end(known_bitrates);
  }
  if (key == "services") {
    changes.service_frames = number<std::uint16_t>(value, 1, 250);
    return changes.service_frames.has_value();
  }
  if (key == "counter") {
    changes.sync_overflow = number<std::uint8_t>(value, 0, 240);
    return changes.sync_overflow && *changes.sync_overflow != 1;
  }
  return add_pdo_change(key, value, changes);
}

void merge(WhatIf& changes, const WhatIf& more) {
  const auto take = [](auto& value, const auto& other) {
    if (other) value = other;
  };
  take(changes.sync_period_us, more.sync_period_us);
  take(changes.bitrate_kbit, more.bitrate_kbit);
  take(changes.service_frames, more.service_frames);
  take(changes.sync_overflow, more.sync_overflow);
  for (const auto& change : more.pdos) {
    auto& pdo =
        change_of(changes, {.node = change.node, .tpdo = change.tpdo, .number = change.number});
    take(pdo.transmission, change.transmission);
    take(pdo.sync_start, change.sync_start);
    take(pdo.inhibit_time, change.inhibit_time);
    take(pdo.cob_id, change.cob_id);
    pdo.off = pdo.off || change.off;
  }
}

std::string to_string(const WhatIf& changes) {
  std::string text;
  if (changes.sync_period_us) append(text, "period=" + time_text(*changes.sync_period_us));
  if (changes.bitrate_kbit) append(text, "bitrate=" + std::to_string(*changes.bitrate_kbit));
  if (changes.service_frames) append(text, "services=" + std::to_string(*changes.service_frames));
  if (changes.sync_overflow) append(text, "counter=" + std::to_string(*changes.sync_overflow));
  for (const auto& pdo : changes.pdos) append(text, pdo);
  return text;
}

}  // namespace takt
