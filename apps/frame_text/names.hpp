#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "eds_parser/network_file/load_network.hpp"

namespace takt {

/// Names and types of nodes and objects, from the network where one is given, else from CiA 301.
class FrameNames {
 public:
  FrameNames() = default;
  /// Keeps a reference.
  explicit FrameNames(const LoadedNetwork& network) : network_{&network} {}

  /// `shoulder`, else `node 5`.
  std::string node(unsigned id) const;
  /// `6041:00 statusword`; without a name where none is known.
  std::string object(unsigned node, ObjectKey key) const;
  /// Type of an object, unknown where nothing tells it.
  DataType type(unsigned node, ObjectKey key) const;

  /// An EMCY code in the words of the node's device data, else of CiA 402 and CiA 301.
  std::string_view emcy(unsigned node, std::uint16_t code) const;
  /// Whose EMCY has this identifier.
  std::optional<NodeId> emcy_sender(CobId id) const;

  const BusPlan* plan() const { return network_ == nullptr ? nullptr : &network_->plan; }

 private:
  const LoadedNetwork* network_ = nullptr;
};

/// Name of an object of the communication profile (`1017:00`: "producer heartbeat time", `1801:02`:
/// "TPDO2 transmission type"); empty for others. CiA 301, 7.5.
std::string communication_object_name(ObjectKey key);

}  // namespace takt
