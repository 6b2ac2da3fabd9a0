#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/table/device_table.hpp"

namespace takt {

/// The names of nodes and the names and types of objects. They come from the network if there is
/// one, else from CiA 301.
class FrameNames {
 public:
  FrameNames() = default;
  /// Keeps a reference to the plan of the network and to the tables of its devices.
  FrameNames(const BusPlan& plan, std::span<const DeviceTable> devices)
      : plan_{&plan}, devices_{devices} {}

  /// Returns the name of a node, `shoulder`, or `node 5` if the name is unknown.
  std::string node(unsigned id) const;
  /// Returns index, sub-index and name of an object, `6041:00 statusword`. The name is left out if
  /// it is unknown.
  std::string object(unsigned node, ObjectKey key) const;
  /// Returns the type of an object, or DataType::unknown.
  DataType type(unsigned node, ObjectKey key) const;

  /// Returns the text of an EMCY code from the device data of the node, or else from CiA 402 and
  /// CiA 301.
  std::string_view emcy(unsigned node, std::uint16_t code) const;
  /// Returns the node whose EMCY has this COB-ID, or std::nullopt if there is none.
  std::optional<NodeId> emcy_sender(CobId id) const;

  /// Returns the plan of the network, or null without a network.
  const BusPlan* plan() const { return plan_; }

 private:
  const BusPlan* plan_ = nullptr;
  std::span<const DeviceTable> devices_;
};

/// Returns the name of an object of the communication profile (`1017:00`: "producer heartbeat
/// time", `1801:02`: "TPDO2 transmission type"). Returns an empty text for other objects. CiA 301,
/// 7.5.
std::string communication_object_name(ObjectKey key);

}  // namespace takt
