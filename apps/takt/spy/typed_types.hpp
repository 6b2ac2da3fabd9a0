#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <string>

#include "apps/takt/spy/message_types.hpp"
#include "eds_parser/table/bus_plan.hpp"

namespace takt::spy {

/// A type of `takt export lcm`.
struct TypedChannel {
  std::string type;
  std::uint64_t fingerprint = 0;
};

/// These types by their channels.
using TypedChannels = std::map<std::string, TypedChannel, std::less<>>;

/// Adds the types of the nodes of a bus to `types`. Returns their channels.
TypedChannels add_typed(MessageTypes& types, const BusPlan& plan);

}  // namespace takt::spy
