#include "eds_parser/budget/what_if.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "eds_parser/report/message.hpp"
#include "eds_parser/values/number_in.hpp"

namespace takt {
namespace {

constexpr std::uint32_t shortest_period_us = 200;

template <class T>
std::optional<T> number(std::string_view text, T least, T most) {
  const bool hex = text.starts_with("0x");
  if (hex) text.remove_prefix(2);
  const auto value = number_in<T>(text, hex ? 16 : 10);
  return value && *value >= least && *value <= most ? value : std::nullopt;
}

/// Reads a number. Returns false if it is not within the bounds.
template <class T>
bool read(std::string_view text, T least, T most, std::optional<T>& out) {
  out = number(text, least, most);
  return out.has_value();
}

/// Reads a time such as "1500us", "2ms" or "1s".
std::optional<std::uint32_t> microseconds_of(std::string_view text) {
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

/// Returns whether a transmission type is reserved. CiA 301, tables 69 and 72.
bool is_reserved(std::uint8_t transmission, bool tpdo) {
  return transmission > 240 && transmission < (tpdo ? 252 : 254);
}

bool set_pdo(std::string_view what, std::string_view value, PdoChange& pdo) {
  if (what.empty() && value == "off") {
    pdo.off = true;
    return true;
  }
  if (what.empty()) {
    return read<std::uint8_t>(value, 0, 255, pdo.transmission) &&
           !is_reserved(*pdo.transmission, pdo.tpdo);
  }
  if (what == "start") return read<std::uint8_t>(value, 0, 240, pdo.sync_start);
  if (what == "cob_id") return read<std::uint32_t>(value, 1, 0x1FFF'FFFF, pdo.cob_id);
  const auto us = what == "inhibit" ? microseconds_of(value) : std::nullopt;
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

std::string short_time(std::uint64_t us) {
  return us % 1000 == 0 ? concat(us / 1000, "ms") : concat(us, "us");
}

/// Adds a change to the list, if the value is given.
template <class Value>
void append_change(std::string& list, std::string_view name, const std::optional<Value>& value) {
  if (value) append(list, list.empty() ? "" : ",", name, '=', *value);
}

void append_pdo(std::string& list, const PdoChange& pdo) {
  const std::string name = concat(pdo.node, pdo.tpdo ? ".tpdo" : ".rpdo", pdo.number);
  if (pdo.off) append_change(list, name, std::optional{"off"});
  append_change(list, name, pdo.transmission);
  append_change(list, name + ".start", pdo.sync_start);
  append_change(list, name + ".inhibit",
                pdo.inhibit_time.transform([](auto units) { return short_time(units * 100U); }));
  append_change(list, name + ".cob_id", pdo.cob_id.transform([](auto id) { return Hex{id, 1}; }));
}

}  // namespace

bool add_change(std::string_view text, WhatIf& changes) {
  const auto equals = text.find('=');
  if (equals == std::string_view::npos) return false;
  const auto key = trim(text.substr(0, equals));
  const auto value = trim(text.substr(equals + 1));
  if (key == "period") {
    changes.sync_period_us = microseconds_of(value);
    return changes.sync_period_us && *changes.sync_period_us >= shortest_period_us;
  }
  if (key == "bitrate") {
    return read<std::uint16_t>(value, 10, 1000, changes.bitrate_kbit) &&
           std::ranges::find(known_bitrates, *changes.bitrate_kbit) != std::end(known_bitrates);
  }
  if (key == "services") return read<std::uint16_t>(value, 1, 250, changes.service_frames);
  if (key == "counter") {
    return read<std::uint8_t>(value, 0, 240, changes.sync_overflow) && changes.sync_overflow != 1;
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
  append_change(text, "period", changes.sync_period_us.transform(short_time));
  append_change(text, "bitrate", changes.bitrate_kbit);
  append_change(text, "services", changes.service_frames);
  append_change(text, "counter", changes.sync_overflow);
  for (const auto& pdo : changes.pdos) append_pdo(text, pdo);
  return text;
}

}  // namespace takt
