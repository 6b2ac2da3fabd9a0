#include "eds_parser/check/check.hpp"

#include "eds_parser/check/rules.hpp"
#include "eds_parser/dictionary/integer_of.hpp"

namespace takt {

std::string pdo_name(const PdoDescription& pdo) {
  return (pdo.is_tpdo ? "TPDO" : "RPDO") + std::to_string(pdo.number);
}

std::string section_name(ObjectKey key) {
  const auto sub = hex(key.sub, 1).substr(2);
  return hex(key.index).substr(2) + "sub" + sub;
}

std::optional<std::uint64_t> number_of(const ObjectDictionary& dictionary, ObjectKey key) {
  const auto integer = integer_of(dictionary, key);
  if (!integer) return std::nullopt;
  return static_cast<std::uint64_t>(*integer);
}

Findings check(const ObjectDictionary& dictionary) {
  Report report{dictionary.file};
  check_values(dictionary, report);
  check_widths(dictionary, report);
  check_mandatory(dictionary, report);
  check_identity(dictionary, report);
  check_profile(dictionary, report);
  check_pdos(dictionary, report);
  check_cob_ids(dictionary, report);
  return report.take();
}

}  // namespace takt
