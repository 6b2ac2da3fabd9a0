#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "apps/takt/live/daemon_client.hpp"
#include "apps/takt/service/file_transfer.hpp"
#include "eds_parser/values/ids.hpp"
#include "master/linux/bus/frame_channel.hpp"

namespace takt {

/// Makes SDO transfers on a bus of this machine without a daemon. Must not be used while a daemon
/// runs on the same bus: two SDO clients of one node disturb each other. Ctrl-C (Interrupt) aborts
/// a transfer on the bus. A transfer that fails throws a Failure.
class SdoDirect {
 public:
  SdoDirect(std::string bus, NodeId node, Time timeout)
      : bus_{std::move(bus)}, node_{node}, timeout_{timeout} {}

  /// Reads one value of at most `request_bytes` bytes.
  std::vector<std::byte> upload(ObjectKey object);
  /// Reads a file by block transfer. If the device sends more than `limit` bytes, the transfer is
  /// aborted.
  std::vector<std::byte> upload(ObjectKey object, std::size_t limit, const Progress& progress);
  void download(ObjectKey object, std::span<const std::byte> value, const Progress& progress = {});

 private:
  FrameChannel open() const;

  std::string bus_;
  NodeId node_;
  Time timeout_;
};

}  // namespace takt
