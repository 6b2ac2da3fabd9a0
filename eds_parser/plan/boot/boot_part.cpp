#include "eds_parser/plan/boot/boot_part.hpp"

#include "eds_parser/dictionary/integer_of.hpp"

namespace takt {

void BootPart::missing(SourcePos pos, const std::string& key, ObjectKey object) const {
  report.error(pos, "no-such-object",
               "`" + key + "` of node `" + spec.name + "` needs " + to_string(object) + ", which " +
                   dictionary.file + " does not have as a writable object");
}

bool BootPart::takes(ObjectKey key, std::int64_t value, SourcePos pos,
                     const std::string& consequence) const {
  const SubObject* sub = dictionary.find(key);
  const auto low = integer_of(sub->low_limit);
  const auto high = integer_of(sub->high_limit);
  if ((!low || value >= *low) && (!high || value <= *high)) return true;
  report.warning(
      pos == SourcePos{} ? spec.pos : pos, "limits",
      "node `" + spec.name + "`: " + label(dictionary, key) + " = " + std::to_string(value) +
          " is outside the limits " + (low ? std::to_string(*low) : "") + ".." +
          (high ? std::to_string(*high) : "") + " of " + dictionary.file +
          "; takt does not write it" + (consequence.empty() ? "" : ", so ") + consequence);
  return false;
}

}  // namespace takt
