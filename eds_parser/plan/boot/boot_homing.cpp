#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "eds_parser/dictionary/integer_of.hpp"
#include "eds_parser/plan/boot/boot_sections.hpp"
#include "eds_parser/specification/object_units.hpp"
#include "eds_parser/values/data_type.hpp"

namespace takt {
namespace {

constexpr std::uint32_t homing_mode = 1U << 5;  // bit of 0x6502

class HomingSteps : BootPart {
 public:
  explicit HomingSteps(const BootPart& part) : BootPart{part} {}

  void run() {
    if (!spec.homing.given) return;
    if (!context.node.cia402) {
      report.error(spec.homing.pos, "homing", "`homing` of node `", spec.name,
                   "`: the node is no CiA 402 drive; write `profile: cia402` if it is one");
      return;
    }
    for (const AxisHomingOverrideSpec& own : spec.homing.axes) {
      if (steps.has(axis_object(own.axis - 1U, 0x6040))) continue;
      report.error(own.pos, "homing", "`homing` of node `", spec.name, "`: ", dictionary.file,
                   " has no axis ", static_cast<unsigned>(own.axis));
    }
    for (unsigned axis = 0; axis < most_axes; ++axis) {
      if (steps.has(axis_object(axis, 0x6040))) run(axis);
    }
  }

 private:
  void run(unsigned axis) {
    const AxisHomingSpec homing = spec.homing.of(static_cast<std::uint8_t>(axis + 1));
    judge_mode(axis, homing);
    if (homing.method.given) {
      judge_method(axis, homing.method);
      write(axis_object(axis, 0x6098), "method", homing.method.pos, *homing.method);
    }
    write(axis_object(axis, 0x6099, 1), "speed_switch", homing.speed_switch);
    write(axis_object(axis, 0x6099, 2), "speed_zero", homing.speed_zero);
    write(axis_object(axis, 0x609A), "acceleration", homing.acceleration);
    write(axis_object(axis, 0x607C), "offset", homing.offset);
  }

  /// Warns if 0x6502 in the device file says that the drive has no homing mode. Without 0x6502, the
  /// modes are unknown, and nothing is reported.
  void judge_mode(unsigned axis, const AxisHomingSpec& homing) {
    const auto modes = value_of(axis_object(axis, 0x6502));
    if (!*homing.required || !modes || *modes == 0 || (*modes & homing_mode) != 0) return;
    report.warning(spec.homing.pos, "homing", "`homing` of node `", spec.name, "`: by ",
                   axis_object(axis, 0x6502), " of ", dictionary.file,
                   ", the drive has no homing mode; write `required: false` if it knows its "
                   "position without homing");
  }

  /// Reports a method that is not in the list of the device file (0x60E3).
  void judge_method(unsigned axis, const Sourced<std::int8_t>& method) {
    std::string known;
    for (unsigned sub = 1; sub < 255; ++sub) {
      const ObjectKey key = axis_object(axis, 0x60E3, static_cast<std::uint8_t>(sub));
      if (!steps.has(key)) break;
      const auto one = value_of(key);
      if (!one) return;
      if (static_cast<std::int8_t>(*one) == *method) return;
      known += (known.empty() ? "" : ", ") + std::to_string(static_cast<std::int8_t>(*one));
    }
    if (known.empty()) return;
    report.warning(method.pos, "homing-method", "`homing` of node `", spec.name,
                   "`: ", dictionary.file, " lists the methods ", known, " in ",
                   axis_object(axis, 0x60E3), ", and not ", static_cast<int>(*method));
  }

  std::optional<std::int64_t> value_of(ObjectKey key) const {
    const SubObject* sub = dictionary.find(key);
    if (sub == nullptr) return {};
    return sub->parameter_value ? integer_of(sub->parameter_value) : integer_of(sub->default_value);
  }

  /// Writes a value that the network file gives in a unit.
  void write(ObjectKey object, const std::string& key, const Sourced<double>& value) {
    if (!value.given) return;
    const double raw = std::round(raw_of(object, *value));
    constexpr double largest = 0x7FFF'FFFF;
    if (!(std::abs(raw) <= largest)) {
      report.error(value.pos, "out-of-range", "`", key, "` of `homing` of node `", spec.name,
                   "`: ", object, " would be above 0x7FFFFFFF");
      return;
    }
    if (raw == 0 && *value != 0) {
      report.warning(value.pos, "out-of-range", "`", key, "` of `homing` of node `", spec.name,
                     "` is less than half a count of ", object, " and becomes 0");
    }
    write(object, key, value.pos, static_cast<std::int64_t>(raw));
  }

  void write(ObjectKey object, const std::string& key, SourcePos pos, std::int64_t raw) {
    if (const SdoSpec* own = spec.written(object)) {
      report.error(own->pos, "written-twice", "`sdo` and `homing` of node `", spec.name,
                   "` both write ", object, ": keep one");
      return;
    }
    if (!steps.writable(object)) return missing(pos, "homing: {" + key + "}", object);
    const BootAction action =
        steps.readable(object) ? BootAction::write_if_differs : BootAction::write;
    steps.integer(action, object, raw, "homing: " + key);
  }

  double raw_of(ObjectKey object, double value) const {
    for (const ObjectUnitSpec& own : spec.units.objects) {
      if (own.object != object) continue;
      return (value - own.unit.offset) / (*own.unit.scale * own.unit.sign);
    }
    const auto quantity = quantity_of(object);
    const auto& unit = spec.units.of(quantity->quantity);
    if (!unit) return value;
    const double offset = quantity->quantity == Quantity::position ? 0.0 : unit->offset;
    return (value - offset) / (*unit->scale * (quantity->directed ? unit->sign : 1));
  }
};

}  // namespace

void append_homing(const BootPart& part) { HomingSteps{part}.run(); }

}  // namespace takt
