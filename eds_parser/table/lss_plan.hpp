#pragma once
#include <array>
#include <cstdint>

namespace takt {

/// The numbers that together identify one device: vendor-ID, product code, revision number, serial
/// number (0x1018:01..04). CiA 305, 3.1.
using LssAddress = std::array<std::uint32_t, 4>;

/// The way in which a node that has no node-ID gets one by LSS.
struct LssPlan {
  LssAddress address{};
  LssAddress known{};  ///< mask of the known bits of `address`; fastscan finds the others
  bool store = true;   ///< the device stores the node-ID permanently
};

}  // namespace takt
