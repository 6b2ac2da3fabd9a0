#include <algorithm>
#include <array>
#include <tuple>
#include <vector>

#include "eds_parser/check/rules.hpp"
#include "eds_parser/number.hpp"
#include "eds_parser/text.hpp"

namespace takt {
namespace {

constexpr std::uint32_t off_flag = 0x8000'0000;
constexpr std::uint32_t extended_flag = 0x2000'0000;

/// A COB-ID entry of the file: constant, and whether the node id is added.
struct CobIdEntry {
  ObjectKey key;
  SourcePos pos;
  std::uint32_t constant = 0;
  bool relative = false;

  bool on() const noexcept { return (constant & off_flag) == 0; }
  bool extended() const noexcept { return (constant & extended_flag) != 0; }
  std::uint32_t id() const noexcept { return constant & (extended() ? 0x1FFF'FFFF : 0x7FF); }
};

struct Range {
  std::uint32_t first;
  std::uint32_t last;
  std::string_view use;
};

/// CiA 301, 7.3.5, table 40.
constexpr Range restricted[] = {{0x000, 0x000, "NMT"},           {0x001, 0x07F, "reserved"},
                                {0x101, 0x180, "reserved"},      {0x581, 0x5FF, "SDO responses"},
                                {0x601, 0x67F, "SDO requests"},  {0x6E0, 0x6FF, "reserved"},
                                {0x701, 0x77F, "error control"}, {0x780, 0x7FF, "reserved, LSS"}};

const Range* restriction_of(std::uint32_t id) noexcept {
  const auto* it = std::ranges::find_if(
      restricted, [id](const Range& range) { return id >= range.first && id <= range.last; });
  return it == std::end(restricted) ? nullptr : it;
}

std::optional<CobIdEntry> entry_of(const ObjectDictionary& dictionary, ObjectKey key) {
  const auto* sub = dictionary.find(key);
  if (sub == nullptr) return std::nullopt;
  const auto& text = sub->parameter_text.empty() ? sub->default_text : sub->parameter_text;
  const auto number = parse_number(text);
  if (!number || number->negative || number->magnitude > 0xFFFF'FFFF) return std::nullopt;
  return CobIdEntry{.key = key,
                    .pos = sub->parameter_text.empty() ? sub->default_pos : sub->parameter_pos,
                    .constant = static_cast<std::uint32_t>(number->magnitude),
                    .relative = number->relative()};
}

std::string start(const CobIdEntry& entry) { return section_name(entry.key) + ": COB-ID "; }

/// Where the node id is added but unknown, the first and the last node are looked at.
void check_restricted(const CobIdEntry& entry, std::optional<NodeId> node, Report& report) {
  const std::uint32_t first = node ? node->value() : 1;
  const std::uint32_t last = node ? node->value() : 127;
  const auto lowest = entry.id() + (entry.relative ? first : 0);
  const auto highest = entry.id() + (entry.relative ? last : 0);
  const auto* range = restriction_of(lowest);
  if (range == nullptr) range = restriction_of(highest);
  const bool too_high = highest > 0x7FF;
  if (entry.extended() || (range == nullptr && !too_high)) return;
  report.error(entry.pos, "cob-id-restricted",
               start(entry) + hex(lowest, 3) + (highest != lowest ? ".." + hex(highest, 3) : "") +
                   (range == nullptr ? " needs more than 11 bits"
                                     : " is restricted (" + std::string{range->use} + ")"));
}

void check_bits(const CobIdEntry& entry, Report& report) {
  if (!entry.extended() && (entry.constant & 0x1FFF'F800) != 0) {
    report.warning(entry.pos, "cob-id-bits",
                   start(entry) + hex(entry.constant, 8) +
                       " has bits above 11, but bit 29 (extended frame) is clear");
  }
}

void check_absolute(const CobIdEntry& entry, bool is_dcf, Report& report) {
  if (entry.relative || is_dcf || entry.extended()) return;
  report.note(entry.pos, "cob-id-absolute",
              start(entry) + hex(entry.id(), 3) +
                  " is the same for every node id; $NODEID+... would let two devices share a bus");
}

void check_twice(std::vector<CobIdEntry> entries, Report& report) {
  const auto order = [](const CobIdEntry& entry) {
    return std::tuple{entry.relative, entry.extended(), entry.id()};
  };
  std::ranges::stable_sort(entries, {}, order);
  for (std::size_t at = 1; at < entries.size(); ++at) {
    if (order(entries[at]) != order(entries[at - 1])) continue;
    report.error(entries[at].pos, "cob-id-twice",
                 start(entries[at]) + (entries[at].relative ? "$NODEID+" : "") +
                     hex(entries[at].id(), 3) + " is used by " + section_name(entries[at - 1].key) +
                     " too");
  }
}

}  // namespace

void check_cob_ids(const ObjectDictionary& dictionary, Report& report) {
  std::vector<CobIdEntry> active;
  for (const auto& pdo : describe_pdos(dictionary)) {
    auto entry = entry_of(dictionary, {pdo.communication_index(), 1});
    if (!entry || !entry->on()) continue;
    check_restricted(*entry, dictionary.node_id, report);
    check_bits(*entry, report);
    check_absolute(*entry, dictionary.is_dcf, report);
    active.push_back(*entry);
  }
  // SYNC, TIME, EMCY: bit 31 and 30 mean other things in the first two
  for (const auto index : std::to_array<std::uint16_t>({0x1005, 0x1012, 0x1014})) {
    auto entry = entry_of(dictionary, {index, 0});
    if (!entry || entry->id() == 0) continue;
    if (index == 0x1014 && !entry->on()) continue;
    entry->constant &= 0x3FFF'FFFF;
    check_restricted(*entry, dictionary.node_id, report);
    if (index == 0x1014) check_absolute(*entry, dictionary.is_dcf, report);
    active.push_back(*entry);
  }
  check_twice(std::move(active), report);
}

}  // namespace takt
