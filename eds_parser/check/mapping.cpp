#include "eds_parser/check/rules.hpp"
#include "eds_parser/report/text.hpp"

namespace takt {
namespace {

/// One entry of a mapping with the data for its findings.
struct Entry {
  const MappedObject& mapped;
  bool is_tpdo;
  ObjectKey record;  ///< for example 1A00 sub 2
  SourcePos pos;
};

std::string start(const Entry& entry) {
  return section_name(entry.record) + ": object " + to_string(entry.mapped.key);
}

void check_dummy(const ObjectDictionary& dictionary, const Entry& entry, Report& report) {
  const auto type = entry.mapped.key.index;
  const bool usable = type >= 1 && type <= 7 && entry.mapped.key.sub == 0;
  if (!usable) {
    report.error(entry.pos, "pdo-dummy",
                 start(entry) + " is not a data type that can fill a gap (0001 to 0007, sub 0)");
    return;
  }
  if (entry.is_tpdo) {
    report.warning(entry.pos, "pdo-dummy",
                   start(entry) + ": CiA 301 has dummy entries for RPDOs only");
  } else if (!dictionary.dummy_usage[type]) {
    report.warning(entry.pos, "pdo-dummy",
                   start(entry) + ": [DummyUsage] does not allow this dummy");
  }
  const auto width = bit_width(static_cast<DataType>(type));
  if (width != entry.mapped.bits) {
    report.error(entry.pos, "pdo-entry-length",
                 start(entry) + " has " + std::to_string(width) + " bits, the entry says " +
                     std::to_string(entry.mapped.bits));
  }
}

void check_direction(const Entry& entry, const SubObject& sub, Report& report) {
  const bool readable = sub.access != Access::wo;
  const bool writable = sub.access != Access::ro && sub.access != Access::constant;
  if (entry.is_tpdo ? !readable : !writable) {
    report.error(
        entry.pos, "pdo-direction",
        start(entry) + (entry.is_tpdo ? " cannot be read (AccessType=wo), so no TPDO can send it"
                                      : " cannot be written (AccessType ro or const), so "
                                        "no RPDO can carry it"));
    return;
  }
  const auto wrong = entry.is_tpdo ? Access::rww : Access::rwr;
  if (sub.access == wrong) {
    report.note(entry.pos, "pdo-direction-hint",
                start(entry) + (entry.is_tpdo ? " is rww, meant for RPDOs, but is sent by a TPDO"
                                              : " is rwr, meant for TPDOs, but is in an RPDO"));
  }
}

void check_entry(const ObjectDictionary& dictionary, const Entry& entry, Report& report) {
  if (entry.mapped.is_dummy()) return check_dummy(dictionary, entry, report);
  const auto* sub = dictionary.find(entry.mapped.key);
  if (sub == nullptr) {
    report.warning(entry.pos, "pdo-object-missing",
                   start(entry) + " is mapped but not described in the file");
    return;
  }
  if (!sub->pdo_mappable) {
    report.error(entry.pos, "pdo-not-mappable",
                 start(entry) + " is not PDO-mappable (PDOMapping=0)");
  }
  check_direction(entry, *sub, report);
  const auto width = bit_width(sub->type);
  // Devices with a granularity of 8 may map a BOOLEAN as a whole byte.
  const bool byte_boolean = sub->type == DataType::boolean && entry.mapped.bits == 8;
  if (width != 0 && width != entry.mapped.bits && !byte_boolean) {
    report.warning(entry.pos, "pdo-entry-length",
                   start(entry) + " is " + std::string{name(sub->type)} + " of " +
                       std::to_string(width) + " bits, the entry says " +
                       std::to_string(entry.mapped.bits) +
                       "; on the bus the length of the entry applies");
  }
}

void check_count(const ObjectDictionary& dictionary, const PdoDescription& pdo, Report& report) {
  const auto* sub = dictionary.find(ObjectKey{pdo.mapping_index(), 0});
  if (!pdo.mapping_count || sub == nullptr) return;
  const unsigned count = *pdo.mapping_count;
  const auto where = section_name({pdo.mapping_index(), 0});
  if (count > 64 && count < 0xFE) {
    report.error(sub->value_pos(), "pdo-mapping-count",
                 where + ": " + std::to_string(count) + " mapped objects; a PDO has at most 64");
  } else if (count <= 64 && count > pdo.mapping.size()) {
    report.warning(sub->value_pos(), "pdo-mapping-count",
                   where + " counts " + std::to_string(count) + " mapped objects, " +
                       (pdo.mapping.empty() ? std::string{"no"}
                                            : "only " + std::to_string(pdo.mapping.size())) +
                       (pdo.mapping.size() == 1 ? " entry has" : " entries have") + " a value");
  }
}

/// Reports entries with a value after an entry without one: their first bit is unknown.
void check_gap(const ObjectDictionary& dictionary, const PdoDescription& pdo, Report& report) {
  if (!pdo.mapping_count || pdo.mapping.empty()) return;
  std::optional<std::uint8_t> missing;
  for (unsigned at = 1; at <= *pdo.mapping_count && at <= 64; ++at) {
    const ObjectKey key{pdo.mapping_index(), static_cast<std::uint8_t>(at)};
    if (number_of(dictionary, key).value_or(0) == 0) {
      if (!missing) missing = key.sub;
    } else if (missing) {
      return report.error(
          dictionary.find(key)->value_pos(), "pdo-mapping-gap",
          section_name(key) + " has a value, but " + section_name({key.index, *missing}) +
              " before it has no value; the positions of all later entries are unknown");
    }
  }
}

}  // namespace

void check_mapping(const ObjectDictionary& dictionary, const PdoDescription& pdo, Report& report) {
  check_count(dictionary, pdo, report);
  check_gap(dictionary, pdo, report);
  const auto* record = dictionary.find(pdo.mapping_index());
  if (record == nullptr || pdo.mapping.empty()) return;
  std::size_t next = 0;
  SourcePos last = record->pos;
  for (const auto& sub : record->subs) {
    if (sub.sub == 0 || next == pdo.mapping.size()) continue;
    const auto raw = number_of(dictionary, {record->index, sub.sub});
    if (raw.value_or(0) == 0 || *raw > 0xFFFF'FFFF) continue;
    last = sub.value_pos();
    check_entry(dictionary, {pdo.mapping[next++], pdo.is_tpdo, {record->index, sub.sub}, last},
                report);
  }
  if (pdo.bits <= 64) return;
  const auto text = pdo_name(pdo) + ": the mapped objects need " + std::to_string(pdo.bits) +
                    " bits, a PDO has 64";
  if (pdo.mapping_count) {
    report.error(last, "pdo-too-long", text);
  } else {
    report.note(last, "pdo-too-long", text + "; sub 0 does not say how many objects are active");
  }
}

}  // namespace takt
