#include <set>

#include "eds_parser/dictionary/integer_of.hpp"
#include "eds_parser/plan/boot/boot_sections.hpp"
#include "eds_parser/plan/pdo/mapping_compiler.hpp"
#include "eds_parser/values/little_endian.hpp"
#include "eds_parser/values/raw_number.hpp"

namespace takt {
namespace {

/// Returns false if the limits are equal or inverted. Such limits are default entries of an EDS
/// editor and do not describe the device.
bool mean_something(const ObjectLimits& limits) {
  return !limits.low || !limits.high || *limits.low < *limits.high;
}

/// Returns true for a step that writes a parameter, but not for the store and restore commands.
bool writes(const BootStep& step) {
  const bool command = step.object.index == 0x1010 || step.object.index == 0x1011;
  const bool write =
      step.action == BootAction::write || step.action == BootAction::write_if_differs;
  return write && !command;
}

/// Returns the number in `bytes`, or std::nullopt if the type is no integer.
std::optional<std::int64_t> number_of(std::span<const std::byte> bytes, DataType type) {
  if (is_real(type) || is_bytes(type) || bytes.empty() || bytes.size() > 8) return {};
  const std::uint64_t number = from_little_endian(bytes);
  if (!is_signed(type)) return static_cast<std::int64_t>(number);
  return sign_extended(number, 8 * static_cast<unsigned>(bytes.size()));
}

class LimitJudge {
 public:
  LimitJudge(const NodePdos& node, NetworkReport& report)
      : node_{node}, spec_{*node.node.spec}, dictionary_{*node.node.dictionary}, report_{report} {}

  void judge(BootStep& step) {
    const SubObject* sub = dictionary_.find(step.object);
    if (sub == nullptr) return;
    const auto value = number_of(step.value, sub->type);
    const ObjectLimits limits{*sub};
    if (!value || limits.hold(*value) || !mean_something(limits)) return;
    if (integer_of(sub->default_value) == value) return;
    step.purpose += " (outside the limits " + limits.text() + " of the device file)";
    if (!reported_.insert(step.object).second) return;
    report_.warning(pos_of(step.object), "limits", source(*sub, step.object, *value),
                    label(dictionary_, step.object), " = ", *value, " is outside the limits ",
                    limits.text(), " of ", dictionary_.file, "; the device may refuse it");
  }

 private:
  SourcePos pos_of(ObjectKey key) const {
    if (const SdoSpec* sdo = spec_.written(key)) return sdo->value_pos;
    for (const EffectivePdo& pdo : node_.pdos) {
      if (pdo.communication_index() == key.index || pdo.mapping_index() == key.index) {
        return pdo.pos;
      }
    }
    return spec_.pos;
  }

  std::string source(const SubObject& sub, ObjectKey key, std::int64_t value) const {
    const std::string node = "node `" + spec_.name + "`";
    if (spec_.written(key) != nullptr) return "`sdo` of " + node + ": ";
    if (integer_of(sub.parameter_value) != value) return node + ": ";
    return concat(node, ", ParameterValue in line ", sub.parameter_pos.line, " of ",
                  dictionary_.file, ": ");
  }

  const NodePdos& node_;
  const NodeSpec& spec_;
  const ObjectDictionary& dictionary_;
  NetworkReport& report_;
  std::set<ObjectKey> reported_;
};

}  // namespace

void judge_limits(const NodePdos& node, BootPlan& plan, NetworkReport& report) {
  LimitJudge judge{node, report};
  for (BootStep& step : plan.steps) {
    if (writes(step)) judge.judge(step);
  }
}

}  // namespace takt
