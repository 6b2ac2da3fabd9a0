#include <algorithm>
#include <array>
#include <cstdlib>
#include <tuple>
#include <utility>
#include <vector>

#include "eds_parser/check/rules.hpp"
#include "eds_parser/ini/number.hpp"
#include "eds_parser/report/text.hpp"

namespace takt {
namespace {

using enum Severity;

constexpr std::uint32_t off_flag = 0x8000'0000;
constexpr std::uint32_t no_remote_flag = 0x4000'0000;
constexpr std::uint32_t extended_flag = 0x2000'0000;

/// A COB-ID entry of the file. `relative` is true if the device adds its node-ID to `constant`.
struct CobIdEntry {
  ObjectKey key;
  SourcePos pos;
  std::uint32_t constant = 0;
  bool relative = false;

  bool on() const noexcept { return (constant & off_flag) == 0; }
  bool extended() const noexcept { return (constant & extended_flag) != 0; }
  bool is_rpdo() const noexcept { return (key.index & 0xFE00) == 0x1400; }
  bool is_sdo_client() const noexcept { return (key.index & 0xFF80) == 0x1280; }
  /// Returns true for a further SDO server, but not for the default server.
  bool is_sdo_server() const noexcept { return key.index > 0x1200 && key.index < 0x1280; }
  std::uint32_t id() const noexcept { return constant & (extended() ? 0x1FFF'FFFF : 0x7FF); }
  std::uint32_t id_of(std::optional<NodeId> node) const noexcept {
    return id() + (relative && node ? node->value() : 0U);
  }
};

struct Range {
  std::uint32_t first;
  std::uint32_t last;
  std::string_view use;
};

/// The restricted CAN-IDs. CiA 301, 7.3.5, table 40.
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
  const auto number = parse_number(sub->text());
  if (!number || number->negative || number->magnitude > 0xFFFF'FFFF) return std::nullopt;
  return CobIdEntry{.key = key,
                    .pos = sub->parameter_text.empty() ? sub->default_pos : sub->parameter_pos,
                    .constant = static_cast<std::uint32_t>(number->magnitude),
                    .relative = number->relative()};
}

std::string start(const CobIdEntry& entry) { return concat(section_name(entry.key), ": COB-ID "); }

/// Returns a COB-ID as the entry writes it: `0x385`, or `$NODEID+0x180`.
std::string sum_text(const CobIdEntry& entry, std::uint32_t constant, int digits = 3) {
  return concat(entry.relative ? "$NODEID+" : "", Hex{constant, digits});
}

std::string id_text(const CobIdEntry& entry) {
  return sum_text(entry, entry.id(), entry.extended() ? 8 : 3);
}

/// Returns true if an SDO client uses the default channel of another device. A client may do this,
/// although the COB-IDs of default channels are restricted.
bool is_default_channel(const CobIdEntry& entry, std::uint32_t id) noexcept {
  const std::uint32_t base = entry.key.sub == 1 ? 0x600 : 0x580;
  return entry.is_sdo_client() && id > base && id <= base + 127;
}

/// The node and the direction of a default SDO channel.
struct DefaultChannel {
  std::string_view direction;
  unsigned node = 0;
};

std::optional<DefaultChannel> default_channel_at(std::uint32_t id) noexcept {
  if (id > 0x600 && id <= 0x67F) return DefaultChannel{"request", id - 0x600};
  if (id > 0x580 && id <= 0x5FF) return DefaultChannel{"answer", id - 0x580};
  return std::nullopt;
}

/// Returns true if a further SDO server has the default channel of another node. Such devices
/// exist, and the channel works as long as that node is not on the bus. `own` is the node-ID of the
/// device; 0 means unknown.
bool is_channel_of_another(const CobIdEntry& entry, std::uint32_t id, unsigned own) noexcept {
  const auto channel = default_channel_at(id);
  return entry.is_sdo_server() && channel && channel->node != own;
}

/// Returns why an entry cannot have this COB-ID. The result is empty if it can.
std::string objection(const CobIdEntry& entry, std::uint32_t id, unsigned own) {
  if (id > 0x7FF) return "needs more than 11 bits";
  const auto* range = restriction_of(id);
  if (range == nullptr || is_default_channel(entry, id)) return "";
  if (is_channel_of_another(entry, id, own)) return "";
  return concat("is restricted (", range->use, ")");
}

/// Returns true if an SDO server uses an identifier that is merely reserved. No other service sends
/// on it, so this is only a deviation.
bool harmless(const CobIdEntry& entry, std::uint32_t id) noexcept {
  const auto* range = restriction_of(id);
  return entry.is_sdo_server() && range != nullptr && range->use == "reserved";
}

/// Checks an entry for restricted identifiers. If the entry adds an unknown node-ID, all node-IDs
/// are checked. The finding is then an error only if node-ID 1 is affected; otherwise it is a
/// warning.
void check_restricted(const CobIdEntry& entry, std::optional<NodeId> node, Report& report) {
  if (entry.extended()) return;
  if (node || !entry.relative) {
    const auto id = entry.id_of(node);
    const auto why = objection(entry, id, node ? node->value() : 0U);
    if (why.empty()) return;
    return report.add(harmless(entry, id) ? warning : error, entry.pos, "cob-id-restricted",
                      start(entry), Hex{id, 3}, ' ', why);
  }
  std::uint32_t first = 0;
  std::uint32_t last = 0;
  for (std::uint32_t any = 1; any <= 127; ++any) {
    if (objection(entry, entry.id() + any, any).empty()) continue;
    if (first == 0) first = any;
    last = any;
  }
  if (first == 0) return;
  const bool clear = first == 1 && !harmless(entry, entry.id() + first);
  report.add(clear ? error : warning, entry.pos, "cob-id-restricted", start(entry), id_text(entry),
             ' ', objection(entry, entry.id() + first, first), " for nodes of ", first, "..", last);
}

/// A range of node-IDs for which an entry takes the default SDO channel of another node. The
/// devices with the node-IDs `first` to `last` take the channel of the node whose node-ID is higher
/// by `away`.
struct Meeting {
  unsigned first = 0;
  unsigned last = 0;
  int away = 0;
  std::string_view direction;
};

std::vector<Meeting> meetings_of(const CobIdEntry& entry) {
  std::vector<Meeting> all;
  for (unsigned own = 1; own <= 127; ++own) {
    const auto channel = default_channel_at(entry.id() + own);
    if (!channel || channel->node == own) continue;
    const int away = static_cast<int>(channel->node) - static_cast<int>(own);
    const bool goes_on = !all.empty() && all.back().away == away && all.back().last + 1 == own;
    if (!goes_on) all.push_back({own, own, away, channel->direction});
    all.back().last = own;
  }
  return all;
}

std::string channels_met(const CobIdEntry& entry, std::optional<NodeId> node) {
  if (node || !entry.relative) {
    const auto id = entry.id_of(node);
    if (!is_channel_of_another(entry, id, node ? node->value() : 0U)) return "";
    const auto channel = *default_channel_at(id);
    return concat(Hex{id, 3}, " is the SDO ", channel.direction, " of node ", channel.node);
  }
  std::string text;
  for (const Meeting& meeting : meetings_of(entry)) {
    text += text.empty() ? id_text(entry) + " is the SDO " : ", and the SDO ";
    text += concat(meeting.direction, " of node $NODEID", meeting.away < 0 ? "-" : "+",
                   std::abs(meeting.away), " for nodes of ", meeting.first, "..", meeting.last);
  }
  return text;
}

void check_further_server(const CobIdEntry& entry, std::optional<NodeId> node, Report& report) {
  if (!entry.is_sdo_server() || entry.extended()) return;
  const auto met = channels_met(entry, node);
  if (met.empty()) return;
  report.warning(entry.pos, "cob-id-restricted", start(entry), met,
                 "; it works while no such node is on the bus");
}

void check_bits(const CobIdEntry& entry, Report& report) {
  if (!entry.extended() && (entry.constant & 0x1FFF'F800) != 0) {
    report.warning(entry.pos, "cob-id-bits", start(entry), Hex{entry.constant, 8},
                   " has bits 11 to 28 in use, but bit 29 (extended frame) is clear");
  }
  if (entry.extended() && entry.id() <= 0x7FF) {
    report.warning(entry.pos, "cob-id-extended", start(entry), sum_text(entry, entry.constant, 8),
                   " has bit 29 set: this is the 29-bit identifier ", id_text(entry),
                   ", although 11 bits are enough; clear bit 29 for a base frame");
  }
}

void check_remote_of_rpdo(const CobIdEntry& entry, Report& report) {
  if (!entry.is_rpdo() || (entry.constant & no_remote_flag) == 0) return;
  report.note(entry.pos, "pdo-rtr-of-rpdo", start(entry), sum_text(entry, entry.constant, 8),
              " has bit 30 set (no remote requests), which has no meaning for an RPDO");
}

/// Warns of bit 30 of EMCY, which is reserved. CiA 301, 7.5.2.17.
void check_reserved_bit(const CobIdEntry& entry, Report& report) {
  if ((entry.constant & no_remote_flag) == 0) return;
  report.warning(entry.pos, "cob-id-bits", start(entry), sum_text(entry, entry.constant, 8),
                 " has bit 30 set, which is reserved (0) for EMCY");
}

void check_absolute(const CobIdEntry& entry, bool is_dcf, Report& report) {
  if (entry.relative || is_dcf) return;
  report.note(entry.pos, "cob-id-absolute", start(entry), id_text(entry),
              " is the same for every node id; $NODEID+... would let two devices share a bus");
}

/// Returns true if two entries may have the same COB-ID. CiA 301 does not forbid two RPDOs with one
/// COB-ID: the device receives both from one frame. Two SDO clients may use one server in turn.
bool may_share(const CobIdEntry& entry, const CobIdEntry& other) noexcept {
  return (entry.is_rpdo() && other.is_rpdo()) || (entry.is_sdo_client() && other.is_sdo_client());
}

void check_twice(std::vector<CobIdEntry> entries, std::optional<NodeId> node, Report& report) {
  const auto order = [node](const CobIdEntry& entry) {
    return std::tuple{entry.relative && !node, entry.extended(), entry.id_of(node)};
  };
  std::ranges::stable_sort(entries, {}, order);
  for (std::size_t at = 1; at < entries.size(); ++at) {
    const auto& entry = entries[at];
    const auto& other = entries[at - 1];
    if (order(entry) != order(other)) continue;
    report.add(may_share(entry, other) ? warning : error, entry.pos, "cob-id-twice", start(entry),
               entry.relative && !node ? "$NODEID+" : "", Hex{entry.id_of(node), 3}, " is used by ",
               section_name(other.key), " too");
  }
}

/// Warns if the default channel of a server does not follow from its node-ID. CiA 301, 7.2.4.3 and
/// 7.5.2.33.
void check_default_channel(const ObjectDictionary& dictionary, const CobIdEntry& entry,
                           Report& report) {
  const std::uint32_t base = entry.key.sub == 1 ? 0x600 : 0x580;
  const auto& node = dictionary.node_id;
  const std::uint32_t first = entry.relative ? base : base + (node ? node->value() : 1U);
  const std::uint32_t last = entry.relative || node ? first : base + 127;
  if (entry.constant >= first && entry.constant <= last) return;
  report.warning(entry.pos, "sdo-default-channel", start(entry), sum_text(entry, entry.constant),
                 " differs from the COB-ID of the default SDO channel, $NODEID+", Hex{base, 3});
}

/// Checks the SDO servers 0x1200..0x127F and the clients 0x1280..0x12FF.
void check_sdo_channels(const ObjectDictionary& dictionary, std::vector<CobIdEntry>& active,
                        Report& report) {
  auto object = std::ranges::lower_bound(dictionary.objects, 0x1200, {}, &Object::index);
  for (; object != dictionary.objects.end() && object->index < 0x1300; ++object) {
    for (const auto sub : std::to_array<std::uint8_t>({1, 2})) {
      const auto entry = entry_of(dictionary, {object->index, sub});
      if (!entry) continue;
      if (object->index == 0x1200) {
        check_default_channel(dictionary, *entry, report);
        continue;
      }
      if (!entry->on() || entry->id() == 0) continue;
      check_restricted(*entry, dictionary.node_id, report);
      check_further_server(*entry, dictionary.node_id, report);
      check_bits(*entry, report);
      if (!entry->is_sdo_client()) check_absolute(*entry, dictionary.is_dcf, report);
      active.push_back(*entry);
    }
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
    check_remote_of_rpdo(*entry, report);
    check_absolute(*entry, dictionary.is_dcf, report);
    active.push_back(*entry);
  }
  // These are the COB-IDs of SYNC, TIME and EMCY. In those of SYNC and TIME, bits 31 and 30 do not
  // mean "off" and "no remote requests".
  for (const auto index : std::to_array<std::uint16_t>({0x1005, 0x1012, 0x1014})) {
    auto entry = entry_of(dictionary, {index, 0});
    if (!entry || entry->id() == 0) continue;
    if (index == 0x1014 && !entry->on()) continue;
    if (index == 0x1014) check_reserved_bit(*entry, report);
    entry->constant &= ~(off_flag | no_remote_flag);
    check_restricted(*entry, dictionary.node_id, report);
    check_bits(*entry, report);
    if (index == 0x1014) check_absolute(*entry, dictionary.is_dcf, report);
    active.push_back(*entry);
  }
  check_sdo_channels(dictionary, active, report);
  check_twice(std::move(active), dictionary.node_id, report);
}

}  // namespace takt
