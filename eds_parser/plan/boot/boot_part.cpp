#include "eds_parser/plan/boot/boot_sections.hpp"

namespace takt {

void BootPart::missing(SourcePos pos, const std::string& key, ObjectKey object) const {
  report.error(pos, "no-such-object", "`", key, "` of node `", spec.name, "` needs ", object,
               ", which ", dictionary.file, " does not have as a writable object");
}

bool BootPart::takes(ObjectKey key, std::int64_t value, SourcePos pos,
                     const std::string& consequence) const {
  const ObjectLimits limits{*dictionary.find(key)};
  if (limits.hold(value)) return true;
  report.warning(pos == SourcePos{} ? spec.pos : pos, "limits", "node `", spec.name,
                 "`: ", label(dictionary, key), " = ", value, " is outside the limits ",
                 limits.text(), " of ", dictionary.file, "; takt does not write it",
                 consequence.empty() ? "" : ", so ", consequence);
  return false;
}

}  // namespace takt
