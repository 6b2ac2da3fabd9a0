#include "eds_parser/check/rules.hpp"

namespace takt {
namespace {

using enum Severity;

/// Checks one entry of a mapping.
class EntryCheck {
 public:
  EntryCheck(const ObjectDictionary& dictionary, const PdoDescription& pdo,
             const MappedObject& mapped, Report& report)
      : dictionary_{dictionary},
        mapped_{mapped},
        is_tpdo_{pdo.is_tpdo},
        record_{pdo.mapping_index(), mapped.sub},
        report_{report} {}

  SourcePos pos() const noexcept { return dictionary_.find(record_)->value_pos(); }

  void run() {
    if (mapped_.is_dummy()) return check_dummy();
    const auto* sub = dictionary_.find(mapped_.key);
    if (sub == nullptr) {
      return add(warning, "pdo-object-missing", " is mapped but not described in the file");
    }
    if (!sub->pdo_mappable) add(error, "pdo-not-mappable", " is not PDO-mappable (PDOMapping=0)");
    check_direction(*sub);
    const auto width = bit_width(sub->type);
    // Devices with a granularity of 8 may map a BOOLEAN as a whole byte.
    const bool byte_boolean = sub->type == DataType::boolean && mapped_.bits == 8;
    if (width != 0 && width != mapped_.bits && !byte_boolean) {
      add(warning, "pdo-entry-length", " is ", sub->type, " of ", width, " bits, the entry says ",
          mapped_.bits, "; on the bus the length of the entry applies");
    }
  }

 private:
  template <class... Parts>
  void add(Severity severity, std::string_view rule, const Parts&... parts) {
    report_.add(severity, pos(), rule, section_name(record_), ": object ", mapped_.key, parts...);
  }

  void check_dummy() {
    const auto type = mapped_.key.index;
    const bool usable = type >= 1 && type <= 7 && mapped_.key.sub == 0;
    if (!usable) {
      return add(error, "pdo-dummy",
                 " is not a data type that can fill a gap (0001 to 0007, sub 0)");
    }
    if (is_tpdo_) {
      add(warning, "pdo-dummy", ": CiA 301 has dummy entries for RPDOs only");
    } else if (!dictionary_.dummy_usage[type]) {
      add(warning, "pdo-dummy", ": [DummyUsage] does not allow this dummy");
    }
    const auto width = bit_width(static_cast<DataType>(type));
    if (width == mapped_.bits) return;
    add(error, "pdo-entry-length", " has ", width, " bits, the entry says ", mapped_.bits);
  }

  void check_direction(const SubObject& sub) {
    if (is_tpdo_ ? sub.access == Access::wo : !sub.is_writable()) {
      add(error, "pdo-direction",
          is_tpdo_ ? " cannot be read (AccessType=wo), so no TPDO can send it"
                   : " cannot be written (AccessType ro or const), so no RPDO can carry it");
    } else if (sub.access == (is_tpdo_ ? Access::rww : Access::rwr)) {
      add(note, "pdo-direction-hint",
          is_tpdo_ ? " is rww, meant for RPDOs, but is sent by a TPDO"
                   : " is rwr, meant for TPDOs, but is in an RPDO");
    }
  }

  const ObjectDictionary& dictionary_;
  const MappedObject& mapped_;
  bool is_tpdo_;
  ObjectKey record_;  ///< object of the mapping entry, for example 1A00 sub 2
  Report& report_;
};

void check_count(const ObjectDictionary& dictionary, const PdoDescription& pdo, Report& report) {
  const ObjectKey key{pdo.mapping_index(), 0};
  if (!pdo.mapping_count) return;
  const unsigned count = *pdo.mapping_count;
  const auto found = pdo.mapping.size();
  const auto pos = dictionary.find(key)->value_pos();
  if (count > 64 && count < 0xFE) {
    report.error(pos, "pdo-mapping-count", section_name(key), ": ", count,
                 " mapped objects; a PDO has at most 64");
  } else if (count <= 64 && count > found) {
    report.warning(pos, "pdo-mapping-count", section_name(key), " counts ", count,
                   " mapped objects, ", found == 0 ? "no" : concat("only ", found),
                   found == 1 ? " entry has" : " entries have", " a value");
  }
}

/// Reports the first entry that has a value although an entry before it has none, because its
/// position in the PDO is then unknown.
void check_gap(const ObjectDictionary& dictionary, const PdoDescription& pdo, Report& report) {
  if (!pdo.mapping_count) return;
  for (unsigned number = 1; const auto& mapped : pdo.mapping) {
    const ObjectKey expected{pdo.mapping_index(), static_cast<std::uint8_t>(number++)};
    if (mapped.sub == expected.sub) continue;
    const ObjectKey key{expected.index, mapped.sub};
    return report.error(dictionary.find(key)->value_pos(), "pdo-mapping-gap", section_name(key),
                        " has a value, but ", section_name(expected),
                        " before it has no value; the positions of all later entries are unknown");
  }
}

}  // namespace

void check_mapping(const ObjectDictionary& dictionary, const PdoDescription& pdo, Report& report) {
  check_count(dictionary, pdo, report);
  check_gap(dictionary, pdo, report);
  for (const auto& mapped : pdo.mapping) EntryCheck{dictionary, pdo, mapped, report}.run();
  if (pdo.bits <= 64) return;
  report.add(pdo.mapping_count ? error : note,
             EntryCheck{dictionary, pdo, pdo.mapping.back(), report}.pos(), "pdo-too-long",
             pdo.label(), ": the mapped objects need ", pdo.bits, " bits, a PDO has 64",
             pdo.mapping_count ? "" : "; sub 0 does not say how many objects are active");
}

}  // namespace takt
