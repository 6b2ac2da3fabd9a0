#include "master/wire/sdo_abort.hpp"

#include <algorithm>
#include <array>

namespace takt {
namespace {

struct AbortText {
  std::uint32_t code;
  std::string_view text;
};

// The rows are in ascending order of the code.
constexpr std::array texts{
    AbortText{0x0503'0000, "the toggle bit did not change"},
    AbortText{0x0504'0000, "SDO time-out"},
    AbortText{0x0504'0001, "command specifier unknown or invalid"},
    AbortText{0x0504'0002, "block size invalid"},
    AbortText{0x0504'0003, "block sequence number invalid"},
    AbortText{0x0504'0004, "CRC error in a block transfer"},
    AbortText{0x0504'0005, "out of memory"},
    AbortText{0x0601'0000, "access to this object not supported"},
    AbortText{0x0601'0001, "attempt to read a write-only object"},
    AbortText{0x0601'0002, "attempt to write a read-only object"},
    AbortText{0x0601'0003, "sub-index can't be written while sub-index 0 is not zero (EtherCAT)"},
    AbortText{0x0601'0004, "complete access not supported (EtherCAT)"},
    AbortText{0x0601'0005, "object length exceeds the mailbox (EtherCAT)"},
    AbortText{0x0601'0006, "object is mapped to an RPDO, SDO download blocked (EtherCAT)"},
    AbortText{0x0602'0000, "object does not exist in the dictionary"},
    AbortText{0x0604'0041, "object can't be mapped into the PDO"},
    AbortText{0x0604'0042, "mapping exceeds the length of the PDO or its number of entries"},
    AbortText{0x0604'0043, "parameters incompatible"},
    AbortText{0x0604'0047, "internal incompatibility in the device"},
    AbortText{0x0606'0000, "hardware error on access"},
    AbortText{0x0607'0010, "data type or length does not match"},
    AbortText{0x0607'0012, "data type does not match, length too high"},
    AbortText{0x0607'0013, "data type does not match, length too low"},
    AbortText{0x0609'0011, "sub-index does not exist"},
    AbortText{0x0609'0030, "value invalid for this parameter"},
    AbortText{0x0609'0031, "value too high"},
    AbortText{0x0609'0032, "value too low"},
    AbortText{0x0609'0033, "configured modules differ from the detected ones (EtherCAT)"},
    AbortText{0x0609'0036, "maximum is below minimum"},
    AbortText{0x060A'0023, "resource (SDO connection) not available"},
    AbortText{0x0800'0000, "general error"},
    AbortText{0x0800'0020, "data can't be transferred or stored to the application"},
    AbortText{0x0800'0021, "data can't be transferred or stored because of local control"},
    AbortText{0x0800'0022, "data can't be transferred or stored in the present device state"},
    AbortText{0x0800'0023, "the device has no object dictionary or could not generate it"},
    AbortText{0x0800'0024, "no data available"},
};
static_assert(std::ranges::is_sorted(texts, {}, &AbortText::code));

}  // namespace

std::string_view abort_text(std::uint32_t code) noexcept {
  const auto found = std::ranges::lower_bound(texts, code, {}, &AbortText::code);
  if (found == texts.end() || found->code != code) return "unknown abort code";
  return found->text;
}

}  // namespace takt
