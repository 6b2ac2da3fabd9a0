#pragma once
#include <array>
#include <cstdint>

namespace takt {

/// What tells a device from all others: vendor id, product code, revision, serial number
/// (0x1018:01..04). CiA 305, 3.1.
using LssAddress = std::array<std::uint32_t, 4>;

/// A node gets its id by LSS where it has none.
struct LssPlan {
  LssAddress address{};
  LssAddress known{};  ///< bits of `address` that are given; the others are found by fastscan
  bool store = true;   ///< the device keeps the id
};

}  // namespace takt
