#include "master/explain/emcy_text.hpp"

#include <algorithm>
#include <array>

namespace takt {
namespace {

struct CodeText {
  std::uint16_t first;
  std::uint16_t last;
  std::string_view text;
};

// Codes of CiA 301 (table 26) and CiA 402. The first row that covers a code is used, so the narrow
// rows come before the classes.
constexpr std::array texts{
    CodeText{0x2110, 0x2113, "short circuit or earth leakage, input side"},
    CodeText{0x2120, 0x2123, "earth leakage, input side"},
    CodeText{0x2130, 0x2133, "short circuit, input side"},
    CodeText{0x2211, 0x2214, "over-current inside the device"},
    CodeText{0x2220, 0x2220, "continuous over-current inside the device"},
    CodeText{0x2230, 0x2230, "short circuit or earth leakage inside the device"},
    CodeText{0x2240, 0x2240, "earth leakage inside the device"},
    CodeText{0x2250, 0x2250, "short circuit inside the device"},
    CodeText{0x2310, 0x2310, "continuous over-current, output side"},
    CodeText{0x2320, 0x2320, "short circuit or earth leakage, output side"},
    CodeText{0x2330, 0x2333, "earth leakage, output side"},
    CodeText{0x2340, 0x2343, "short circuit, output side"},
    CodeText{0x3110, 0x3113, "mains over-voltage"},
    CodeText{0x3120, 0x3123, "mains under-voltage"},
    CodeText{0x3130, 0x3134, "mains phase failure or wrong phase sequence"},
    CodeText{0x3140, 0x3142, "mains frequency out of range"},
    CodeText{0x3210, 0x3212, "DC link over-voltage"},
    CodeText{0x3220, 0x3222, "DC link under-voltage"},
    CodeText{0x3230, 0x3230, "load error"},
    CodeText{0x3310, 0x3313, "output over-voltage"},
    CodeText{0x3320, 0x3331, "armature or field circuit"},
    CodeText{0x4110, 0x4140, "ambient or supply air temperature"},
    CodeText{0x4210, 0x4210, "device temperature too high"},
    CodeText{0x4220, 0x4220, "device temperature too low"},
    CodeText{0x4310, 0x4310, "drive temperature too high"},
    CodeText{0x4320, 0x4320, "drive temperature too low"},
    CodeText{0x4410, 0x4410, "supply temperature too high"},
    CodeText{0x4420, 0x4420, "supply temperature too low"},
    CodeText{0x5100, 0x51FF, "supply voltage of the device hardware"},
    CodeText{0x5200, 0x52FF, "control, measurement or computing hardware"},
    CodeText{0x5300, 0x53FF, "operating unit"},
    CodeText{0x5400, 0x54FF, "power section hardware"},
    CodeText{0x5500, 0x55FF, "data storage hardware"},
    CodeText{0x6010, 0x6010, "software reset by the watchdog"},
    CodeText{0x6301, 0x630F, "data set error"},
    CodeText{0x6310, 0x6310, "loss of parameters"},
    CodeText{0x6320, 0x6320, "parameter error"},
    CodeText{0x7110, 0x7113, "brake chopper"},
    CodeText{0x7121, 0x7121, "motor blocked"},
    CodeText{0x7122, 0x7122, "motor error or commutation fault"},
    CodeText{0x7123, 0x7123, "motor tilted"},
    CodeText{0x7100, 0x71FF, "power module or motor"},
    CodeText{0x7200, 0x72FF, "measurement circuit"},
    CodeText{0x7301, 0x7302, "tacho sensor"},
    CodeText{0x7303, 0x7304, "resolver"},
    CodeText{0x7305, 0x7307, "incremental sensor"},
    CodeText{0x7310, 0x7310, "speed sensor"},
    CodeText{0x7320, 0x7320, "position sensor"},
    CodeText{0x7300, 0x73FF, "sensor"},
    CodeText{0x7400, 0x74FF, "computation circuit"},
    CodeText{0x7500, 0x75FF, "serial interface of the device"},
    CodeText{0x7600, 0x76FF, "data storage module"},
    CodeText{0x8110, 0x8110, "CAN overrun, messages lost"},
    CodeText{0x8120, 0x8120, "CAN in error-passive mode"},
    CodeText{0x8130, 0x8130,
             "life guard or heartbeat error: a node that the device monitors is silent"},
    CodeText{0x8140, 0x8140, "recovered from bus-off"},
    CodeText{0x8150, 0x8150, "collision of CAN identifiers"},
    CodeText{0x8210, 0x821F, "PDO not processed: its length is wrong"},
    CodeText{0x8220, 0x822F, "PDO longer than its mapping"},
    CodeText{0x8230, 0x8230, "destination of an MPDO not available"},
    CodeText{0x8240, 0x8240, "SYNC of unexpected length: does 0x1019 agree with `sync_overflow`?"},
    CodeText{0x8250, 0x825F, "RPDO time-out: the device waits for a PDO of the master"},
    CodeText{0x8311, 0x8311, "torque too high"},
    CodeText{0x8312, 0x8312, "start-up torque"},
    CodeText{0x8313, 0x8313, "standstill torque"},
    CodeText{0x8321, 0x8321, "torque insufficient"},
    CodeText{0x8331, 0x8331, "torque fault"},
    CodeText{0x8300, 0x83FF, "torque controller"},
    CodeText{0x8400, 0x84FF, "velocity controller"},
    CodeText{0x8500, 0x85FF, "position controller"},
    CodeText{0x8611, 0x8611, "following error"},
    CodeText{0x8612, 0x8612, "reference limit"},
    CodeText{0x8600, 0x86FF, "positioning controller"},
    CodeText{0x8700, 0x87FF, "sync controller: does SYNC arrive on time?"},
    CodeText{0x8800, 0x88FF, "winding controller"},
    CodeText{0xF001, 0xF001, "deceleration"},
    CodeText{0xF002, 0xF002, "sub-synchronous run"},
    CodeText{0xF003, 0xF003, "stroke operation"},
    CodeText{0xF004, 0xF004, "control"},
    // classes of error codes
    CodeText{0x0000, 0x00FF, "error reset or no error"},
    CodeText{0x1000, 0x10FF, "generic error"},
    CodeText{0x2100, 0x21FF, "current, input side"},
    CodeText{0x2200, 0x22FF, "current inside the device"},
    CodeText{0x2300, 0x23FF, "current, output side"},
    CodeText{0x2000, 0x2FFF, "current"},
    CodeText{0x3100, 0x31FF, "mains voltage"},
    CodeText{0x3200, 0x32FF, "voltage inside the device"},
    CodeText{0x3300, 0x33FF, "output voltage"},
    CodeText{0x3000, 0x3FFF, "voltage"},
    CodeText{0x4100, 0x41FF, "ambient temperature"},
    CodeText{0x4200, 0x42FF, "device temperature"},
    CodeText{0x4000, 0x4FFF, "temperature"},
    CodeText{0x5000, 0x5FFF, "device hardware"},
    CodeText{0x6100, 0x61FF, "internal software"},
    CodeText{0x6200, 0x62FF, "user software"},
    CodeText{0x6300, 0x63FF, "data set"},
    CodeText{0x6000, 0x6FFF, "device software"},
    CodeText{0x7000, 0x7FFF, "additional modules"},
    CodeText{0x8100, 0x81FF, "communication"},
    CodeText{0x8200, 0x82FF, "protocol error"},
    CodeText{0x8000, 0x8FFF, "monitoring"},
    CodeText{0x9000, 0x9FFF, "external error"},
    CodeText{0xF000, 0xF0FF, "additional functions"},
    CodeText{0xFF00, 0xFFFF, "device-specific: see the manual of the device"},
    CodeText{0x0000, 0xFFFF,
             "CiA 301 and 402 do not define this code: see the manual of the device"},
};

constexpr std::array<std::string_view, 8> register_bits{
    "generic",       "current", "voltage",        "temperature",
    "communication", "profile", "reserved bit 6", "manufacturer"};

}  // namespace

std::string_view emcy_text(std::uint16_t code) noexcept {
  return std::ranges::find_if(
             texts, [code](const CodeText& row) { return row.first <= code && code <= row.last; })
      ->text;
}

std::string_view emcy_text(const NodePlan* node, std::uint16_t code) noexcept {
  if (node == nullptr) return emcy_text(code);
  const auto own = std::ranges::find(node->emcy_texts, code, &EmcyText::code);
  return own == node->emcy_texts.end() ? emcy_text(code) : std::string_view{own->text};
}

std::string error_register_text(std::uint8_t error_register) {
  std::string text;
  for (std::size_t bit = 0; bit < register_bits.size(); ++bit) {
    if ((error_register >> bit & 1) == 0) continue;
    if (!text.empty()) text += ", ";
    text += register_bits[bit];
  }
  return text.empty() ? "none" : text;
}

}  // namespace takt
