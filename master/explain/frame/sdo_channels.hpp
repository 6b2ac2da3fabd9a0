#pragma once
#include <optional>
#include <span>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/table/device_table.hpp"
#include "eds_parser/table/sdo_access.hpp"
#include "master/explain/frame/frame_names.hpp"
#include "master/explain/frame/meaning.hpp"
#include "master/explain/frame/sdo_text.hpp"

namespace takt {

/// SDO channels of a bus: the default channel of every node, the channels in the network file, and
/// the channels in the EDS files of the devices (0x1201 to 0x127F). Each channel follows its own
/// transfers.
class SdoChannels {
 public:
  explicit SdoChannels(const FrameNames& names);
  /// Adds the channels of the network.
  SdoChannels(const FrameNames& names, const BusPlan& plan, std::span<const DeviceTable> devices);

  /// Describes a frame. Returns std::nullopt if it belongs to no SDO channel.
  std::optional<FrameMeaning> meaning(const Frame& frame);

 private:
  struct Channel {
    unsigned node;
    SdoChannel ids;
    unsigned number;  // 1 is the default channel
    SdoText text;
  };

  void add(unsigned node, const SdoChannel& ids);

  const FrameNames* names_;
  std::vector<Channel> channels_;  // default channels first, at index node-ID - 1
};

}  // namespace takt
