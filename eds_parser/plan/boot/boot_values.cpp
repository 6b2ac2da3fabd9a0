#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <set>

#include "eds_parser/dictionary/integer_of.hpp"
#include "eds_parser/dictionary/pdo_description.hpp"
#include "eds_parser/plan/boot/boot_sections.hpp"
#include "eds_parser/specification/device_data.hpp"
#include "eds_parser/specification/object_units.hpp"
#include "eds_parser/values/data_type.hpp"
#include "eds_parser/values/little_endian.hpp"

namespace takt {
namespace {

constexpr std::uint32_t refuse_write_on_download = 1;
constexpr std::size_t longest_compared = 256;

/// Returns true for objects that other parts of the boot write, and for objects that takt writes
/// only if the network file lists them.
bool is_set_elsewhere(std::uint16_t index) {
  constexpr std::array<std::uint16_t, 11> set{0x1000, 0x1003, 0x1005, 0x1006, 0x1010, 0x1011,
                                              0x1014, 0x1017, 0x1018, 0x1019, 0x1020};
  return std::ranges::find(set, index) != set.end() || is_pdo_parameter(index) ||
         (index >= 0x1200 && index <= 0x12FF) || (index >= 0x1F50 && index <= 0x1F5F);
}

/// A period as value * 10^exponent seconds, in the format of 0x60C2. interpolation() returns
/// std::nullopt if no such form exists.
struct Interpolation {
  std::int64_t value;
  std::int64_t exponent;
};
std::optional<Interpolation> interpolation(std::uint32_t period_us) {
  std::uint32_t unit_us = 1000;
  for (std::int64_t exponent = -3; exponent >= -6; --exponent, unit_us /= 10) {
    if (period_us % unit_us == 0 && period_us / unit_us <= 255) {
      return Interpolation{period_us / unit_us, exponent};
    }
  }
  return {};
}

class ValueSteps : BootPart {
 public:
  explicit ValueSteps(const BootPart& part) : BootPart{part} {
    for (const BootStep& step : steps.steps()) {
      if (step.object != ObjectKey{}) set_already_.insert(step.object);
    }
  }

  void run() {
    if (context.node.cia402 && context.plan.cycle.sync) interpolation_periods();
    if (context.node.cia402) open_point_buffers();
    if (dictionary.is_dcf) device_values();
    if (node.data != nullptr) {
      for (const ValueEdit& edit : node.data->values) of_device_data(edit);
    }
    for (const SdoSpec& sdo : spec.sdo) configured(sdo);
  }

 private:
  std::uint32_t sync_period_us() const { return *context.master.sync_period_us; }

  /// Writes the values of a DCF. Values that follow from the plan or that the network file states
  /// take precedence.
  void device_values() {
    for (const Object& object : dictionary.objects) {
      if (is_set_elsewhere(object.index)) continue;
      domains(object.index);
      for (const SubObject& sub : object.subs) {
        const ObjectKey key{object.index, sub.sub};
        if (!sub.parameter_value || !sub.is_configurable() || spec.written(key)) continue;
        if (set_already_.contains(key)) continue;
        write(key, to_bytes(*sub.parameter_value, sub.type),
              "DCF: " + label(dictionary, key) + " = " + sub.parameter_text);
      }
    }
  }

  /// Writes the DownloadFile of a DCF. Short files are first compared with the device if the object
  /// is readable.
  void domains(std::uint16_t index) {
    for (const DomainFiles& files : dictionary.domain_files) {
      if (files.key.index != index || files.content.empty()) continue;
      const SubObject* sub = dictionary.find(files.key);
      const bool refused = sub == nullptr || (sub->flags & refuse_write_on_download) != 0;
      if (refused || spec.written(files.key)) continue;
      std::string purpose = concat("DCF: ", label(dictionary, files.key), " = file ",
                                   files.download, ", ", files.content.size(), " bytes");
      if (files.content.size() <= longest_compared && steps.readable(files.key)) {
        write(files.key, files.content, std::move(purpose));
        continue;
      }
      steps.bytes(BootAction::download_program, files.key, files.content, std::move(purpose))
          .timeout = segment_time;
    }
  }

  void write(ObjectKey key, std::vector<std::byte> value, std::string purpose) {
    const BootAction action =
        steps.readable(key) ? BootAction::write_if_differs : BootAction::write;
    steps.bytes(action, key, std::move(value), std::move(purpose));
  }

  /// Sets 0x60C2 of every axis to the SYNC period, unless the network file sets 0x60C2 itself.
  void interpolation_periods() {
    for (std::uint32_t index = 0x60C2; index < 0xA000; index += 0x800) {
      const ObjectKey value{static_cast<std::uint16_t>(index), 1};
      const ObjectKey exponent{static_cast<std::uint16_t>(index), 2};
      if (!steps.writable(value) || !steps.has(exponent)) continue;
      if (const SdoSpec* own = spec.written(value)) {
        compare_period(*own, exponent_of(exponent));
        continue;
      }
      const auto period = interpolation(sync_period_us());
      if (!period) {
        report.warning(spec.pos, "interpolation-period", "node `", spec.name, "`: ", value,
                       " can't express the SYNC period of ", sync_period_us(), " us");
        continue;
      }
      const std::string text = "interpolation period = SYNC period";
      steps.integer(BootAction::write_if_differs, value, period->value, text, 1);
      set_already_.insert(value);
      if (!steps.writable(exponent)) continue;
      steps.integer(BootAction::write_if_differs, exponent, period->exponent,
                    concat(text, " (x 10^", period->exponent, " s)"), 1);
      set_already_.insert(exponent);
    }
  }

  /// Opens the buffers of points of interpolated position mode: a drive takes no points while
  /// 0x60C4:06 is 0. CiA 402-2, 0x60C4.
  void open_point_buffers() {
    for (unsigned axis = 0; axis < most_axes; ++axis) {
      const ObjectKey access = axis_object(axis, 0x60C4, 6);
      const bool has_points =
          context.plan.layout.find(context.node_index, axis_object(axis, 0x60C1, 1), true)
              .has_value();
      if (!has_points || !steps.writable(access) || spec.written(access)) continue;
      steps.integer(BootAction::write, access, 1, "open the buffer of points", 1);
      set_already_.insert(access);
    }
  }

  /// Returns the power of 10 that scales 0x60C2 to seconds: the value of the network file, else of
  /// the DCF, else -3 (milliseconds).
  std::int64_t exponent_of(ObjectKey key) const {
    const std::int64_t* power = spec.written_integer(key);
    // A file may state -3 as the UNSIGNED8 value 253.
    if (power != nullptr) return static_cast<std::int8_t>(*power);
    const SubObject* sub = dictionary.find(key);
    return sub != nullptr && in_dcf(*sub) ? integer_of(sub->parameter_value).value_or(-3) : -3;
  }

  void compare_period(const SdoSpec& value, std::int64_t exponent) {
    const std::int64_t* counts = value.integer();
    if (counts == nullptr) return;
    const double us =
        static_cast<double>(*counts) * std::pow(10.0, static_cast<double>(exponent)) * 1e6;
    if (std::abs(us - sync_period_us()) < 0.5) return;
    report.warning(value.pos, "interpolation-period", "node `", spec.name, "`: ", value.object,
                   " sets ", static_cast<std::int64_t>(std::llround(us)),
                   " us, but the SYNC period is ", sync_period_us(),
                   " us: in cyclic synchronous modes the axis will not move evenly (without this "
                   "entry takt sets the right value)");
  }

  /// Writes a value of the device data. A value of the network file or of a DCF takes precedence.
  void of_device_data(const ValueEdit& edit) {
    const SubObject* sub = dictionary.find(edit.object);
    if (spec.written(edit.object) || (sub != nullptr && in_dcf(*sub))) return;
    if (sub == nullptr || !steps.writable(edit.object)) {
      report.warning(spec.pos, "device-data", "node `", spec.name, "`: ", edit.object, ", which ",
                     node.data->name, " requires takt to write, ",
                     sub == nullptr ? "is not in " : "is read-only in ", dictionary.file,
                     node.data->cite(edit.fact));
      return;
    }
    const SdoSpec sdo{
        .object = edit.object, .value = edit.value, .pos = spec.pos, .value_pos = spec.pos};
    auto value = bytes_of(sdo, *sub);
    if (value)
      write(edit.object, std::move(*value), "device data: " + label(dictionary, edit.object));
  }

  bool in_dcf(const SubObject& sub) const {
    return dictionary.is_dcf && sub.parameter_value.has_value();
  }

  void configured(const SdoSpec& sdo) {
    if (is_pdo_parameter(sdo.object.index)) {
      if (dictionary.find(sdo.object) == nullptr) missing(sdo);
      report.note(sdo.pos, "pdo-by-sdo", sdo.object, " of node `", spec.name,
                  "` becomes part of the PDO configuration; `tpdo:` or `rpdo:` is the clearer "
                  "place for it");
      return;
    }
    const SubObject* sub = dictionary.find(sdo.object);
    const auto* raw = std::get_if<std::vector<std::byte>>(&sdo.value);
    if (sub == nullptr && raw != nullptr) return unknown_object(sdo, *raw);
    if (sub == nullptr) return missing(sdo);
    if (!steps.writable(sdo.object)) {
      report.error(sdo.pos, "read-only", "`sdo` of node `", spec.name,
                   "`: ", label(dictionary, sdo.object), " can only be read");
      return;
    }
    auto value = bytes_of(sdo, *sub);
    if (!value) return;
    if (sdo.object == ObjectKey{0x1006, 0}) compare_sync_period(sdo);
    write(sdo.object, std::move(*value), "sdo: " + label(dictionary, sdo.object));
  }

  /// Warns if an `sdo:` entry sets 0x1006 to another value than the SYNC period. The value 0
  /// switches the supervision of SYNC off and is not compared.
  void compare_sync_period(const SdoSpec& sdo) {
    const std::int64_t* us = sdo.integer();
    if (!context.plan.cycle.sync || us == nullptr || *us == 0 || *us == sync_period_us()) return;
    report.warning(
        sdo.pos, "sync-period", "node `", spec.name, "` gets a SYNC period of ", *us,
        " us, but the period is ", sync_period_us(),
        " us: the device may report loss of SYNC (without this entry takt sets the right value)");
  }

  /// Writes an object that the EDS does not list. A concise DCF may contain such objects.
  void unknown_object(const SdoSpec& sdo, const std::vector<std::byte>& value) {
    report.warning(sdo.pos, "no-such-object", "node `", spec.name, "`: ", sdo.object,
                   " of the concise DCF is not in ", dictionary.file,
                   "; takt writes it nevertheless");
    steps.bytes(BootAction::write, sdo.object, value, "sdo: " + to_string(sdo.object));
  }

  void missing(const SdoSpec& sdo) {
    const Object* object = dictionary.find(sdo.object.index);
    std::string hint = without_0x(dictionary, sdo.object.index);
    if (object != nullptr && !object->subs.empty()) {
      hint = concat("; ", hex(object->index), " ", object->name, " has sub-index ",
                    object->subs.front().sub, "..", object->subs.back().sub);
    }
    report.error(sdo.pos, "no-such-object", "`sdo` of node `", spec.name, "`: object ", sdo.object,
                 " is not in ", dictionary.file, hint);
  }

  template <class... Parts>
  void wrong_value(const SdoSpec& sdo, const SubObject& sub, const Parts&... why) {
    report.error(sdo.value_pos, "out-of-range", "`sdo` of node `", spec.name,
                 "`: ", label(dictionary, sdo.object), " (", name(sub.type), ") ", why...);
  }

  std::optional<std::vector<std::byte>> bytes_of(const SdoSpec& sdo, const SubObject& sub) {
    if (const auto* raw = std::get_if<std::vector<std::byte>>(&sdo.value)) return *raw;
    if (is_bytes(sub.type)) {
      if (sdo.quoted) return to_bytes(Value{*sdo.quoted}, sub.type);
      if (const auto* text = std::get_if<std::string>(&sdo.value)) {
        return to_bytes(Value{*text}, sub.type);
      }
      wrong_value(sdo, sub, "takes text in quotes");
      return {};
    }
    report_quoted(sdo, sub);
    if (const auto* real = std::get_if<double>(&sdo.value)) {
      const bool too_large = sub.type == DataType::real32 && exceeds_real32(*real);
      if (is_real(sub.type) && !too_large) return to_bytes(Value{*real}, sub.type);
      wrong_value(sdo, sub, too_large ? "holds at most 3.4e38" : "takes whole numbers");
      return {};
    }
    const std::int64_t* integer = sdo.integer();
    if (integer == nullptr) {
      wrong_value(sdo, sub, "takes a number");
      return {};
    }
    if (is_real(sub.type)) return to_bytes(Value{static_cast<double>(*integer)}, sub.type);
    if (!fits(sdo, sub, *integer)) return {};
    return little_endian(*integer, byte_width(sub.type));
  }

  void report_quoted(const SdoSpec& sdo, const SubObject& sub) {
    if (!sdo.quoted || std::holds_alternative<std::string>(sdo.value)) return;
    report.note(sdo.value_pos, "quoted-number", "`sdo` of node `", spec.name,
                "`: ", label(dictionary, sdo.object), " (", name(sub.type),
                ") gets the number in the quotes, ", *sdo.quoted,
                "; write the number without quotes");
  }

  /// Returns a range as text: `-128..127, or 0x80..0xFF as bits`.
  static std::string range_text(DataType type, std::int64_t low, std::int64_t high) {
    const unsigned bits = bit_width(type);
    if (!is_signed(type) || bits >= 63) return concat(low, "..", high);
    const auto bits_text = [bits](std::int64_t value) {
      std::array<char, 20> text{};
      std::snprintf(text.data(), text.size(), "0x%0*llX", static_cast<int>((bits + 3) / 4),
                    static_cast<long long>(value));
      return std::string{text.data()};
    };
    return concat(low, "..", -low - 1, ", or ", bits_text(-low), "..", bits_text(high), " as bits");
  }

  /// Returns true if the object can hold the value. A bit pattern of the width of the type
  /// (0xFFFFFFFF for -1) is accepted as well.
  bool fits(const SdoSpec& sdo, const SubObject& sub, std::int64_t value) {
    const unsigned bits = bit_width(sub.type);
    const bool sign = is_signed(sub.type);
    const std::int64_t low = sign && bits < 64 ? -(std::int64_t{1} << (bits - 1))
                             : sign            ? std::numeric_limits<std::int64_t>::min()
                                               : 0;
    const std::int64_t high =
        bits >= 63 ? std::numeric_limits<std::int64_t>::max() : (std::int64_t{1} << bits) - 1;
    if (value >= low && value <= high) return true;
    wrong_value(sdo, sub, "holds ", range_text(sub.type, low, high), ", not ", value);
    return false;
  }

  std::set<ObjectKey> set_already_;  ///< objects that earlier parts of the boot set
};

}  // namespace

void append_values(const BootPart& part) { ValueSteps{part}.run(); }

}  // namespace takt
