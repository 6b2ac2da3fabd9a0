#include "eds_parser/check/check.hpp"

#include "eds_parser/check/rules.hpp"

namespace takt {

std::string section_name(ObjectKey key) {
  return concat(hex(key.index).substr(2), "sub", hex(key.sub, 1).substr(2));
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
