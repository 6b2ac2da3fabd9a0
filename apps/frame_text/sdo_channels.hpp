#pragma once
#include <optional>
#include <vector>

#include "apps/frame_text/meaning.hpp"
#include "apps/frame_text/names.hpp"
#include "apps/frame_text/sdo_text.hpp"
#include "eds_parser/table/sdo_access.hpp"

namespace takt {

/// The SDO channels of a bus: the default one of every node, those that the network file gives, and
/// those of the devices' descriptions (0x1201 and so on). Each follows its own transfers.
class SdoChannels {
 public:
  explicit SdoChannels(const FrameNames& names);
  /// Adds the channels of the network.
  SdoChannels(const FrameNames& names, const LoadedNetwork& network);

  /// None: no frame of an SDO channel.
  std::optional<FrameMeaning> meaning(const Frame& frame);

 private:
  struct Channel {
    unsigned node;
    SdoChannel ids;
    unsigned number;  // 1: the default one
    SdoText text;
  };

  void add(unsigned node, const SdoChannel& ids);

  const FrameNames* names_;
  std::vector<Channel> channels_;  // the default ones first, at node id - 1
};

}  // namespace takt
