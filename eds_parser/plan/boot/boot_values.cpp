#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <charconv>
#include <cmath>
#include <set>

#include "eds_parser/dictionary/integer_of.hpp"
#include "eds_parser/dictionary/pdo_description.hpp"
#include "eds_parser/plan/boot/boot_sections.hpp"
#include "eds_parser/specification/device_data.hpp"
#include "eds_parser/specification/object_units.hpp"
#include "eds_parser/table/real_range.hpp"

namespace takt {
namespace {

constexpr std::uint32_t refuse_write_on_download = 1;
constexpr std::size_t longest_compared = 256;
// Longest time between two answers of a download.
constexpr Time segment_time = std::chrono::seconds{5};

/// Returns true for objects that other parts of the boot set, and for objects that only a person
/// should write.
bool is_set_elsewhere(std::uint16_t index) {
  switch (index) {
    case 0x1000:
    case 0x1003:
    case 0x1005:
    case 0x1006:
    case 0x1010:
    case 0x1011:
    case 0x1014:
    case 0x1017:
    case 0x1018:
    case 0x1019:
    case 0x1020:
      return true;
    default:
      return is_pdo_parameter(index) || (index >= 0x1200 && index <= 0x12FF) ||
             (index >= 0x1F50 && index <= 0x1F5F);
  }
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

class ValueSteps {
 public:
  ValueSteps(const NodeSource& node, const BootContext& context, BootSteps& steps,
             NetworkReport& report)
      : spec_{*node.spec},
        dictionary_{*node.dictionary},
        data_{node.data},
        context_{context},
        steps_{steps},
        report_{report} {
    for (const BootStep& step : steps.steps()) {
      if (step.object != ObjectKey{}) set_already_.insert(step.object);
    }
  }

  void run() {
    if (context_.cia402 && context_.sync) interpolation_periods();
    if (dictionary_.is_dcf) device_values();
    if (data_ != nullptr) {
      for (const ValueEdit& edit : data_->values) of_device_data(edit);
    }
    for (const SdoSpec& sdo : spec_.sdo) configured(sdo);
  }

 private:
  const SdoSpec* configured_value(ObjectKey key) const {
    const auto found = std::ranges::find(spec_.sdo, key, &SdoSpec::object);
    return found == spec_.sdo.end() ? nullptr : &*found;
  }

  /// Writes the values of a DCF. Values that follow from the plan or that the network file states
  /// take precedence.
  void device_values() {
    for (const Object& object : dictionary_.objects) {
      if (is_set_elsewhere(object.index)) continue;
      domains(object.index);
      for (const SubObject& sub : object.subs) {
        const ObjectKey key{object.index, sub.sub};
        const bool refused = (sub.flags & refuse_write_on_download) != 0;
        if (!sub.parameter_value || refused || !steps_.writable(key) || configured_value(key)) {
          continue;
        }
        if (set_already_.contains(key)) continue;
        write(key, to_bytes(*sub.parameter_value, sub.type),
              "DCF: " + label(dictionary_, key) + " = " + sub.parameter_text);
      }
    }
  }

  /// Writes the DownloadFile of a DCF. Short files are first compared with the device if the object
  /// is readable.
  void domains(std::uint16_t index) {
    for (const DomainFiles& files : dictionary_.domain_files) {
      if (files.key.index != index || files.content.empty()) continue;
      const SubObject* sub = dictionary_.find(files.key);
      const bool refused = sub == nullptr || (sub->flags & refuse_write_on_download) != 0;
      if (refused || configured_value(files.key)) continue;
      std::string purpose = "DCF: " + label(dictionary_, files.key) + " = file " + files.download +
                            ", " + std::to_string(files.content.size()) + " bytes";
      if (files.content.size() <= longest_compared && steps_.readable(files.key)) {
        write(files.key, files.content, std::move(purpose));
        continue;
      }
      steps_.bytes(BootAction::download_program, files.key, files.content, std::move(purpose))
          .timeout = segment_time;
    }
  }

  void write(ObjectKey key, std::vector<std::byte> value, std::string purpose) {
    const BootAction action =
        steps_.readable(key) ? BootAction::write_if_differs : BootAction::write;
    BootStep& step = steps_.bytes(action, key, std::move(value), std::move(purpose));
    if (step.value.size() > 4) step.mask = 0xFFFF'FFFF;
  }

  /// Sets 0x60C2 of every axis to the SYNC period, unless the network file sets 0x60C2 itself.
  void interpolation_periods() {
    for (std::uint32_t index = 0x60C2; index < 0xA000; index += 0x800) {
      const ObjectKey value{static_cast<std::uint16_t>(index), 1};
      const ObjectKey exponent{static_cast<std::uint16_t>(index), 2};
      if (!steps_.writable(value) || !steps_.has(exponent)) continue;
      const SdoSpec* own = configured_value(value);
      if (own != nullptr) {
        compare_period(*own, exponent_of(exponent));
        continue;
      }
      const auto period = interpolation(context_.sync_period_us);
      if (!period) {
        report_.warning(spec_.pos, "interpolation-period",
                        "node `" + spec_.name + "`: " + to_string(value) +
                            " can't express the SYNC period of " +
                            std::to_string(context_.sync_period_us) + " us");
        continue;
      }
      const std::string text = "interpolation period = SYNC period";
      steps_.integer(BootAction::write_if_differs, value, period->value, text, 1);
      set_already_.insert(value);
      if (steps_.writable(exponent)) {
        steps_.integer(BootAction::write_if_differs, exponent, period->exponent,
                       text + " (x 10^" + std::to_string(period->exponent) + " s)", 1);
        set_already_.insert(exponent);
      }
    }
  }

  /// Returns the power of 10 that scales 0x60C2 to seconds: the value of the network file, else of
  /// the DCF, else -3 (milliseconds).
  std::int64_t exponent_of(ObjectKey key) const {
    const SdoSpec* own = configured_value(key);
    const auto* power = own == nullptr ? nullptr : std::get_if<std::int64_t>(&own->value);
    // The file may hold 253 for -3 as UNSIGNED8.
    if (power != nullptr) return static_cast<std::int8_t>(*power);
    const SubObject* sub = dictionary_.find(key);
    const bool of_dcf = dictionary_.is_dcf && sub != nullptr;
    return of_dcf ? integer_of(sub->parameter_value).value_or(-3) : -3;
  }

  void compare_period(const SdoSpec& value, std::int64_t exponent) {
    const auto* counts = std::get_if<std::int64_t>(&value.value);
    if (counts == nullptr) return;
    const double seconds =
        static_cast<double>(*counts) * std::pow(10.0, static_cast<double>(exponent));
    const double us = seconds * 1e6;
    if (std::abs(us - context_.sync_period_us) < 0.5) return;
    report_.warning(value.pos, "interpolation-period",
                    "node `" + spec_.name + "`: " + to_string(value.object) + " sets " +
                        std::to_string(static_cast<std::int64_t>(std::llround(us))) +
                        " us, but the SYNC period is " + std::to_string(context_.sync_period_us) +
                        " us: in cyclic synchronous modes the axis will not move evenly (without "
                        "this entry takt sets the right value)");
  }

  /// Writes a value of the device data. A value of the network file or of a DCF takes precedence.
  void of_device_data(const ValueEdit& edit) {
    const SubObject* sub = dictionary_.find(edit.object);
    if (configured_value(edit.object) || (sub != nullptr && in_dcf(*sub))) return;
    if (sub == nullptr || !steps_.writable(edit.object)) {
      report_.warning(spec_.pos, "device-data",
                      "node `" + spec_.name + "`: " + to_string(edit.object) + ", which " +
                          data_->name + " requires takt to write, " +
                          (sub == nullptr ? "is not in " : "is read-only in ") + dictionary_.file +
                          data_->cite(edit.fact));
      return;
    }
    const SdoSpec sdo{
        .object = edit.object, .value = edit.value, .pos = spec_.pos, .value_pos = spec_.pos};
    auto value = bytes_of(sdo, *sub);
    if (value)
      write(edit.object, std::move(*value), "device data: " + label(dictionary_, edit.object));
  }

  bool in_dcf(const SubObject& sub) const {
    return dictionary_.is_dcf && sub.parameter_value.has_value();
  }

  void configured(const SdoSpec& sdo) {
    if (is_pdo_parameter(sdo.object.index)) {
      if (dictionary_.find(sdo.object) == nullptr) missing(sdo);
      report_.note(sdo.pos, "pdo-by-sdo",
                   to_string(sdo.object) + " of node `" + spec_.name +
                       "` becomes part of the PDO configuration; `tpdo:` or `rpdo:` is the clearer "
                       "place for it");
      return;
    }
    const SubObject* sub = dictionary_.find(sdo.object);
    const auto* raw = std::get_if<std::vector<std::byte>>(&sdo.value);
    if (sub == nullptr && raw != nullptr) return unknown_object(sdo, *raw);
    if (sub == nullptr) return missing(sdo);
    if (!steps_.writable(sdo.object)) {
      report_.error(sdo.pos, "read-only",
                    "`sdo` of node `" + spec_.name + "`: " + label(dictionary_, sdo.object) +
                        " can only be read");
      return;
    }
    auto value = bytes_of(sdo, *sub);
    if (!value) return;
    if (sdo.object == ObjectKey{0x1006, 0}) compare_sync_period(sdo);
    write(sdo.object, std::move(*value), "sdo: " + label(dictionary_, sdo.object));
  }

  /// Warns if the SYNC period differs. 0 disables the supervision of SYNC, so it is not compared.
  void compare_sync_period(const SdoSpec& sdo) {
    const auto* us = std::get_if<std::int64_t>(&sdo.value);
    if (!context_.sync || us == nullptr || *us == 0 || *us == context_.sync_period_us) return;
    report_.warning(sdo.pos, "sync-period",
                    "node `" + spec_.name + "` gets a SYNC period of " + std::to_string(*us) +
                        " us, but the period is " + std::to_string(context_.sync_period_us) +
                        " us: the device may report loss of SYNC (without this entry takt sets the "
                        "right value)");
  }

  /// Writes an object that is not in the EDS. A concise DCF may contain such objects.
  void unknown_object(const SdoSpec& sdo, const std::vector<std::byte>& value) {
    report_.warning(sdo.pos, "no-such-object",
                    "node `" + spec_.name + "`: " + to_string(sdo.object) +
                        " of the concise DCF is not in " + dictionary_.file +
                        "; takt writes it nevertheless");
    steps_.bytes(BootAction::write, sdo.object, value, "sdo: " + to_string(sdo.object));
  }

  void missing(const SdoSpec& sdo) {
    const Object* object = dictionary_.find(sdo.object.index);
    std::string hint = without_0x(dictionary_, sdo.object.index);
    if (object != nullptr && !object->subs.empty()) {
      hint = "; " + hex(object->index) + " " + object->name + " has sub-index " +
             std::to_string(object->subs.front().sub) + ".." +
             std::to_string(object->subs.back().sub);
    }
    report_.error(sdo.pos, "no-such-object",
                  "`sdo` of node `" + spec_.name + "`: object " + to_string(sdo.object) +
                      " is not in " + dictionary_.file + hint);
  }

  void wrong_value(const SdoSpec& sdo, const SubObject& sub, const std::string& why) {
    report_.error(sdo.value_pos, "out-of-range",
                  "`sdo` of node `" + spec_.name + "`: " + label(dictionary_, sdo.object) + " (" +
                      std::string{name(sub.type)} + ") " + why);
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
    const auto* integer = std::get_if<std::int64_t>(&sdo.value);
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
    report_.note(sdo.value_pos, "quoted-number",
                 "`sdo` of node `" + spec_.name + "`: " + label(dictionary_, sdo.object) + " (" +
                     std::string{name(sub.type)} + ") gets the number in the quotes, " +
                     *sdo.quoted + "; write the number without quotes");
  }

  /// Returns a range as text: `-128..127, or 0x80..0xFF as bits`.
  static std::string range_text(DataType type, std::int64_t low, std::int64_t high) {
    const unsigned bits = bit_width(type);
    if (!is_signed(type) || bits >= 63) return std::to_string(low) + ".." + std::to_string(high);
    const auto bits_text = [bits](std::int64_t value) {
      std::array<char, 16> digits{};
      const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value, 16).ptr;
      std::string text{digits.data(), end};
      std::ranges::transform(text, text.begin(),
                             [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
      const std::size_t width = (bits + 3) / 4;
      return "0x" + std::string(width - std::min(width, text.size()), '0') + text;
    };
    return std::to_string(low) + ".." + std::to_string(-low - 1) + ", or " + bits_text(-low) +
           ".." + bits_text(high) + " as bits";
  }

  /// Also accepts a bit pattern of the width of the type (0xFFFFFFFF for -1).
  bool fits(const SdoSpec& sdo, const SubObject& sub, std::int64_t value) {
    const unsigned bits = bit_width(sub.type);
    const bool sign = is_signed(sub.type);
    const std::int64_t low = sign && bits < 64 ? -(std::int64_t{1} << (bits - 1))
                             : sign            ? std::numeric_limits<std::int64_t>::min()
                                               : 0;
    const std::int64_t high =
        bits >= 63 ? std::numeric_limits<std::int64_t>::max() : (std::int64_t{1} << bits) - 1;
    if (value < low || value > high) {
      wrong_value(sdo, sub,
                  "holds " + range_text(sub.type, low, high) + ", not " + std::to_string(value));
      return false;
    }
    return true;
  }

  const NodeSpec& spec_;
  const ObjectDictionary& dictionary_;
  const DeviceData* data_;  ///< nullptr if the node has no entry
  const BootContext& context_;
  BootSteps& steps_;
  NetworkReport& report_;
  std::set<ObjectKey> set_already_;  ///< objects that earlier parts of the boot set
};

}  // namespace

void append_values(const NodeSource& node, const BootContext& context, BootSteps& steps,
                   NetworkReport& report) {
  ValueSteps{node, context, steps, report}.run();
}

}  // namespace takt
