#include <algorithm>

#include "eds_parser/check/rules.hpp"
#include "eds_parser/report/text.hpp"

namespace takt {
namespace {

/// Names the limit that a value violates.
std::string broken_limit(const Value& value, const SubObject& sub) {
  const bool low =
      sub.low_limit && sub.low_limit->index() == value.index() && value < *sub.low_limit;
  return low ? " is below LowLimit " + eds_value_text(*sub.low_limit, sub.type)
             : " is above HighLimit " + eds_value_text(*sub.high_limit, sub.type);
}

void check_limits(ObjectKey key, const SubObject& sub, Report& report) {
  if (sub.default_value && outside_limits(*sub.default_value, sub)) {
    report.warning(sub.default_pos, "default-outside-limits", section_name(key), ": DefaultValue ",
                   Quoted{sub.default_text}, broken_limit(*sub.default_value, sub), "; it is kept");
  }
  if (!sub.parameter_value || !outside_limits(*sub.parameter_value, sub)) return;
  const auto text = section_name(key) + ": ParameterValue " + quoted(sub.parameter_text) +
                    broken_limit(*sub.parameter_value, sub) + "; ";
  if (sub.is_configurable()) {
    report.error(sub.parameter_pos, "value-outside-limits", text, "the device would refuse it");
  } else {
    report.note(sub.parameter_pos, "value-outside-limits", text, "it is never written");
  }
}

/// Returns true for objects whose sub 0 counts something that changes: stored errors, active
/// entries.
bool counts_at_run_time(std::uint16_t index) noexcept {
  return index == 0x1003 || is_pdo_mapping(index);
}

void check_count(const Object& object, Report& report) {
  const bool structured = object.type == ObjectType::array || object.type == ObjectType::record;
  if (!structured || object.subs.empty() || counts_at_run_time(object.index)) return;
  const auto& first = object.subs.front();
  if (first.sub != 0) {
    report.warning(object.pos, "sub-0-missing", Hex{object.index}, " has sub-objects but no sub 0");
    return;
  }
  std::uint8_t highest = 0;
  for (const auto& sub : object.subs) {
    if (sub.sub != 0xFF) highest = sub.sub;
  }
  const auto declared = integer_of(first.default_value);
  if (declared && *declared != highest) {
    report.note(first.default_pos, "sub-0-count", section_name({object.index, 0}),
                ": DefaultValue is ", *declared, ", the highest sub-index described is ", highest);
  }
}

void check_bit_rate(const ObjectDictionary& dictionary, Report& report) {
  const auto& rates = dictionary.device.baud_rates_kbit;
  const auto declared = dictionary.commissioning.baudrate_kbit;
  if (declared == 0 || rates.empty() || std::ranges::binary_search(rates, declared)) return;
  std::string known;
  for (const auto rate : rates) append_item(known, rate);
  report.warning(dictionary.commissioning.baudrate_pos, "baudrate-unsupported", "Baudrate is ",
                 declared, " kbit/s; according to [DeviceInfo] the device has ", known);
}

}  // namespace

void check_values(const ObjectDictionary& dictionary, Report& report) {
  std::size_t parameter_values = 0;
  SourcePos first_parameter_value;
  for (const auto& object : dictionary.objects) {
    for (const auto& sub : object.subs) {
      const ObjectKey key{object.index, sub.sub};
      check_limits(key, sub, report);
      if (sub.parameter_text.empty()) continue;
      if (parameter_values++ == 0) first_parameter_value = sub.parameter_pos;
    }
    check_count(object, report);
  }
  check_bit_rate(dictionary, report);
  if (!dictionary.is_dcf && parameter_values != 0) {
    report.note(first_parameter_value, "parameter-value-in-eds",
                "ParameterValue belongs in a DCF, not in an EDS; takt read ", parameter_values,
                " of them as values and writes them at boot only if the file is named .dcf");
  }
  if (dictionary.is_dcf && !dictionary.commissioning.node_id) {
    const auto& section = dictionary.commissioning.pos;
    report.warning(section.line == 0 ? SourcePos{1, 1} : section, "dcf-without-node-id",
                   "this DCF has no NodeID of 1..127 in [DeviceComissioning]");
  }
}

}  // namespace takt
