#pragma once
#include <cstdint>
#include <string_view>

namespace takt {

/// SDO abort codes that takt itself sends or evaluates. CiA 301, 7.2.4.3.17, table 22.
namespace abort_code {
inline constexpr std::uint32_t toggle_not_alternated = 0x0503'0000;
inline constexpr std::uint32_t timeout = 0x0504'0000;
inline constexpr std::uint32_t command_unknown = 0x0504'0001;
inline constexpr std::uint32_t block_size = 0x0504'0002;
inline constexpr std::uint32_t sequence = 0x0504'0003;
inline constexpr std::uint32_t crc = 0x0504'0004;
inline constexpr std::uint32_t out_of_memory = 0x0504'0005;
inline constexpr std::uint32_t access_unsupported = 0x0601'0000;
inline constexpr std::uint32_t write_only = 0x0601'0001;
inline constexpr std::uint32_t read_only = 0x0601'0002;
inline constexpr std::uint32_t no_object = 0x0602'0000;
inline constexpr std::uint32_t not_mappable = 0x0604'0041;
inline constexpr std::uint32_t mapping_too_long = 0x0604'0042;
inline constexpr std::uint32_t incompatible_parameters = 0x0604'0043;
inline constexpr std::uint32_t incompatible_device = 0x0604'0047;
inline constexpr std::uint32_t hardware_error = 0x0606'0000;
inline constexpr std::uint32_t length_mismatch = 0x0607'0010;
inline constexpr std::uint32_t length_too_high = 0x0607'0012;
inline constexpr std::uint32_t length_too_low = 0x0607'0013;
inline constexpr std::uint32_t no_sub_index = 0x0609'0011;
inline constexpr std::uint32_t invalid_value = 0x0609'0030;
inline constexpr std::uint32_t value_too_high = 0x0609'0031;
inline constexpr std::uint32_t value_too_low = 0x0609'0032;
inline constexpr std::uint32_t resource_unavailable = 0x060A'0023;
inline constexpr std::uint32_t general_error = 0x0800'0000;
inline constexpr std::uint32_t cannot_store = 0x0800'0020;
inline constexpr std::uint32_t local_control = 0x0800'0021;
inline constexpr std::uint32_t device_state = 0x0800'0022;
inline constexpr std::uint32_t no_data = 0x0800'0024;
}  // namespace abort_code

/// Describes an abort code in words. It knows the codes of CiA 301, and those of EtherCAT that some
/// CANopen devices use; all others are an "unknown abort code".
std::string_view abort_text(std::uint32_t code) noexcept;

}  // namespace takt
