#include <algorithm>
#include <string>

#include "eds_parser/plan/image/signal_rules.hpp"
#include "eds_parser/plan/pdo/mapping_compiler.hpp"
#include "eds_parser/values/data_type.hpp"

namespace takt {
namespace {

std::string object_text(ObjectKey object, const SubObject& sub) {
  return to_string(object) + (sub.name.empty() ? "" : " " + sub.name);
}

/// Returns true if `value` can be written into the object. A bit pattern of the width of the type
/// (0xFF for -1) is accepted.
bool fits(std::int64_t value, DataType type) {
  const unsigned bits = bit_width(type);
  if (bits == 0 || bits >= 63 || is_real(type)) return true;
  const std::int64_t low = is_signed(type) ? -(std::int64_t{1} << (bits - 1)) : 0;
  return value >= low && value < std::int64_t{1} << bits;
}

bool in_an_rpdo(const NodePdos& node, ObjectKey object) {
  return std::ranges::any_of(node.pdos, [object](const EffectivePdo& pdo) {
    return !pdo.is_tpdo && pdo.use == PdoUse::exchanged && pdo.maps(object);
  });
}

class ValueCheck {
 public:
  ValueCheck(const NodePdos& node, NetworkReport& report) : node_{node}, report_{report} {}

  void safe_value(const SdoSpec& safe) {
    const SubObject* sub = find(safe.object, safe.pos, "`safe_values`");
    if (sub == nullptr) return;
    const std::int64_t* value = safe.integer();
    const auto* real = std::get_if<double>(&safe.value);
    const bool too_large =
        real != nullptr && sub->type == DataType::real32 && exceeds_real32(*real);
    if ((value != nullptr && !fits(*value, sub->type)) || too_large) {
      report_.error(safe.value_pos, "out-of-range", "`safe_values` of ", owner(), ": ",
                    object_text(safe.object, *sub), " (", name(sub->type), ") does not hold ",
                    too_large ? "more than 3.4e38" : std::to_string(*value));
    }
    if (node_.node.spec->has_rpdo_errors || in_an_rpdo(node_, safe.object)) return;
    report_.error(safe.pos, "not-an-output", "`safe_values` of ", owner(), ": no RPDO carries ",
                  object_text(safe.object, *sub),
                  ", so the value would never be sent; map it under `rpdo:`, or write it once at "
                  "boot under `sdo:`");
  }

  void unit(const ObjectUnitSpec& unit) { find(unit.object, unit.unit.pos, "`units: objects`"); }

 private:
  std::string owner() const { return "node `" + node_.node.spec->name + "`"; }

  const SubObject* find(ObjectKey object, SourcePos pos, const std::string& list) {
    const SubObject* sub = node_.node.dictionary->find(object);
    if (sub == nullptr) {
      report_.error(pos, "no-such-object", list, " of ", owner(), ": object ", object,
                    " is not in ", node_.node.dictionary->file,
                    without_0x(*node_.node.dictionary, object.index));
    }
    return sub;
  }

  const NodePdos& node_;
  NetworkReport& report_;
};

}  // namespace

void check_node_values(const NodePdos& node, NetworkReport& report) {
  ValueCheck check{node, report};
  for (const SdoSpec& safe : node.node.spec->safe_values) check.safe_value(safe);
  for (const ObjectUnitSpec& unit : node.node.spec->units.objects) check.unit(unit);
}

}  // namespace takt
