#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <string>

#include "apps/takt/spy/message_types.hpp"
#include "eds_parser/table/bus_plan.hpp"

namespace takt::spy {

/// A message type of `takt export lcm`.
struct TypedChannel {
  std::string type;
  std::uint64_t fingerprint = 0;
};

/// The types of `takt export lcm` by their channels.
using TypedChannels = std::map<std::string, TypedChannel, std::less<>>;

/// Adds the message types of the nodes of a bus to `types`. Returns the channels of these types.
TypedChannels add_typed(MessageTypes& types, const BusPlan& plan);

}  // namespace takt::spy
