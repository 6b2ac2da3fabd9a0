#pragma once
#include "test/unit/master/sim/device/sample_device.hpp"

namespace takt::sim {

/// Makes a CiA 402 drive with the objects of all modes.
inline SampleDevice drive(NodeId node) {
  using enum DataType;
  SampleDevice device = communicating(node);
  device.model("drive402")
      .object(0x6007, 0, integer16, Access::rw, 1)
      .object(0x603F, 0, unsigned16, Access::ro, 0, true)
      .object(0x6040, 0, unsigned16, Access::rw, 0, true)
      .object(0x6041, 0, unsigned16, Access::ro, 0, true)
      .object(0x605A, 0, integer16, Access::rw, 2)
      .object(0x605B, 0, integer16, Access::rw, 0)
      .object(0x605C, 0, integer16, Access::rw, 1)
      .object(0x605E, 0, integer16, Access::rw, 2)
      .object(0x6060, 0, integer8, Access::rw, 0, true)
      .object(0x6061, 0, integer8, Access::ro, 0, true)
      .object(0x6064, 0, integer32, Access::ro, 0, true)
      .object(0x6065, 0, unsigned32, Access::rw, 0xFFFFFFFF)
      .object(0x6066, 0, unsigned16, Access::rw, 10)
      .object(0x6067, 0, unsigned32, Access::rw, 5)
      .object(0x606C, 0, integer32, Access::ro, 0, true)
      .object(0x6071, 0, integer16, Access::rw, 0, true)
      .object(0x6077, 0, integer16, Access::ro, 0, true)
      .object(0x607A, 0, integer32, Access::rw, 0, true)
      .object(0x607C, 0, integer32, Access::rw, 0)
      .object(0x607D, 0, unsigned8, Access::constant, 2)
      .object(0x607D, 1, integer32, Access::rw, 0)
      .object(0x607D, 2, integer32, Access::rw, 0)
      .object(0x6081, 0, unsigned32, Access::rw, 10'000)
      .object(0x6083, 0, unsigned32, Access::rw, 100'000)
      .object(0x6084, 0, unsigned32, Access::rw, 100'000)
      .object(0x6085, 0, unsigned32, Access::rw, 400'000)
      .object(0x6098, 0, integer8, Access::rw, 35)
      .object(0x6099, 0, unsigned8, Access::constant, 2)
      .object(0x6099, 1, unsigned32, Access::rw, 5'000)
      .object(0x6099, 2, unsigned32, Access::rw, 500)
      .object(0x609A, 0, unsigned32, Access::rw, 100'000)
      .object(0x60F4, 0, integer32, Access::ro, 0, true)
      .object(0x60FD, 0, unsigned32, Access::ro, 0, true)
      .object(0x60FF, 0, integer32, Access::rw, 0, true)
      .object(0x6502, 0, unsigned32, Access::ro, 0x3AD);
  return device;
}

}  // namespace takt::sim
