#include <cstddef>
#include <string>

#include "eds_parser/check/rules.hpp"

namespace takt {
namespace {

/// Returns the function that an object of the communication profile loses without its bits 16 to
/// 31. The result is empty if it loses nothing, or if this is unknown. CiA 301, 7.5.2.
std::string_view function_of_high_bits(ObjectKey key) noexcept {
  const bool is_entry = key.sub != 0;
  switch (key.index) {
    case 0x1005:
      return "bit 30, with which the device produces SYNC";
    case 0x1006:
      return "SYNC periods of more than 65 ms";
    case 0x1012:
      return "bits 30 and 31, with which the device produces or consumes TIME";
    case 0x1014:
      return "bit 31, which has to be set while the COB-ID of EMCY changes";
    case 0x1010:
      return is_entry ? "the signature \"save\": nothing can be stored" : "";
    case 0x1011:
      return is_entry ? "the signature \"load\": nothing can be restored" : "";
    case 0x1016:
      return is_entry ? "the node id in bits 16 to 23: the device can't watch the heartbeat of the "
                        "master, or of any node"
                      : "";
    default:
      break;
  }
  const bool of_channel = key.sub == 1 || key.sub == 2;
  if (key.index >= 0x1200 && key.index <= 0x12FF && of_channel) {
    return "bit 31, which switches the SDO channel off while its COB-IDs change";
  }
  if (is_pdo_communication(key.index) && key.sub == 1) {
    return "bit 31, which switches the PDO off for a new mapping";
  }
  const bool maps = is_pdo_mapping(key.index) && is_entry;
  return maps ? "the index of the object in bits 16 to 31: nothing can be mapped" : "";
}

bool has_limits_of_16_bits(const SubObject& sub) {
  const auto high = integer_of(sub.high_limit);
  const bool is_32_bits = sub.type == DataType::unsigned32 || sub.type == DataType::integer32;
  return is_32_bits && sub.is_configurable() && (high == 0xFFFF || high == 0x7FFF);
}

/// Returns for example "607Asub0 (-32768..32767)", or "6083sub0 (up to 65535)" if there is no
/// LowLimit.
std::string range_text(ObjectKey key, const SubObject& sub) {
  const auto low = integer_of(sub.low_limit);
  return concat(section_name(key), " (", low ? concat(*low, "..") : "up to ",
                integer_of(sub.high_limit).value_or(0), ")");
}

/// Finds 32-bit objects with the limits of 16 bits, which are a mistake of the tool that wrote the
/// file. Each object of the communication profile that loses a function gets its own warning. All
/// other objects are listed in one note.
class WidthOfLimits {
 public:
  explicit WidthOfLimits(Report& report) : report_{report} {}

  void add(ObjectKey key, const SubObject& sub) {
    if (!has_limits_of_16_bits(sub)) return;
    const std::string_view lost = function_of_high_bits(key);
    if (!lost.empty() && sub.type == DataType::unsigned32) return report_lost(key, sub, lost);
    if (count_++ == 0) first_ = sub.pos;
    if (count_ > most_named) return;
    append_item(names_, range_text(key, sub));
  }

  void report_others() {
    if (count_ == 0) return;
    const bool one = count_ == 1;
    const std::string more =
        count_ > most_named ? " and " + std::to_string(count_ - most_named) + " more" : "";
    report_.note(
        first_, "range-of-16-bits",
        one ? "a 32-bit object has" : std::to_string(count_) + " 32-bit objects have",
        " the limits of 16 bits: ", names_, more,
        "; takt refuses values outside them. Correct the limits if the device accepts more");
  }

 private:
  void report_lost(ObjectKey key, const SubObject& sub, std::string_view lost) {
    report_.warning(sub.pos, "limits-of-16-bits", section_name(key), ": UNSIGNED32 with HighLimit ",
                    integer_of(sub.high_limit).value_or(0), ", the limit of 16 bits; it excludes ",
                    lost, ". Correct HighLimit to 0xFFFFFFFF if the device accepts more");
  }

  static constexpr std::size_t most_named = 4;

  Report& report_;
  std::size_t count_ = 0;
  SourcePos first_{};
  std::string names_;
};

}  // namespace

void check_widths(const ObjectDictionary& dictionary, Report& report) {
  WidthOfLimits widths{report};
  for (const auto& object : dictionary.objects) {
    for (const auto& sub : object.subs) widths.add({object.index, sub.sub}, sub);
  }
  widths.report_others();
}

}  // namespace takt
