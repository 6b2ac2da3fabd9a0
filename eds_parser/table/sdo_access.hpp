#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "eds_parser/values/ids.hpp"
#include "eds_parser/values/time.hpp"

namespace takt {

/// The two identifiers of an SDO channel. CiA 301, 7.5.2.33.
struct SdoChannel {
  CobId request;  ///< client to server
  CobId answer;   ///< server to client

  constexpr bool operator==(const SdoChannel&) const noexcept = default;
  constexpr bool has(CobId id) const noexcept { return id == request || id == answer; }
};

/// Returns the default SDO channel of a device. CiA 301, 7.3.3.
constexpr SdoChannel default_sdo_channel(NodeId server) noexcept {
  return {CobId::base(0x600U + server.value()), CobId::base(0x580U + server.value())};
}

/// States whether the master uses block transfers for large values.
enum class SdoBlockUse : std::uint8_t {
  automatic,  ///< block transfers if the device supports them
  off,
};

/// A longer (or shorter) time-out for one object, for example one that writes flash.
struct SdoObjectTimeout {
  std::uint16_t index = 0;
  std::optional<std::uint8_t> sub{};  ///< empty = every sub-index
  Time timeout{};
};

/// The settings with which the master accesses the SDO server of one node.
struct SdoAccess {
  std::optional<SdoChannel> channel{};  ///< empty = the default channel
  SdoBlockUse block = SdoBlockUse::automatic;
  std::vector<SdoObjectTimeout> timeouts{};

  SdoChannel channel_of(NodeId node) const noexcept {
    return channel.value_or(default_sdo_channel(node));
  }
  /// Returns the time-out of the object, or `otherwise` if none is set for it.
  Time timeout_of(ObjectKey key, Time otherwise) const noexcept {
    for (const SdoObjectTimeout& entry : timeouts) {
      if (entry.index == key.index && (!entry.sub || *entry.sub == key.sub)) return entry.timeout;
    }
    return otherwise;
  }
};

}  // namespace takt
