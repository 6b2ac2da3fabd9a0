#pragma once
#include <cstdint>

namespace takt::sim {

/// SDO abort codes that a simulated device sends. CiA 301, table 22.
enum class Abort : std::uint32_t {
  none = 0,
  toggle = 0x0503'0000,
  timeout = 0x0504'0000,
  command = 0x0504'0001,
  block_size = 0x0504'0002,
  sequence = 0x0504'0003,
  crc = 0x0504'0004,
  memory = 0x0504'0005,
  unsupported_access = 0x0601'0000,
  write_only = 0x0601'0001,
  read_only = 0x0601'0002,
  no_object = 0x0602'0000,
  not_mappable = 0x0604'0041,
  pdo_length = 0x0604'0042,
  incompatible = 0x0604'0043,
  type_mismatch = 0x0607'0010,
  too_long = 0x0607'0012,
  too_short = 0x0607'0013,
  no_sub = 0x0609'0011,
  value = 0x0609'0030,
  value_high = 0x0609'0031,
  value_low = 0x0609'0032,
  general = 0x0800'0000,
  store = 0x0800'0020,
  device_state = 0x0800'0022,
  no_data = 0x0800'0024,
};

}  // namespace takt::sim
