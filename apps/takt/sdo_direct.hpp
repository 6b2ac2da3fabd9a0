#pragma once
#include <cstddef>
#include <expected>
#include <span>
#include <string>
#include <vector>

#include "apps/takt/daemon_client.hpp"
#include "apps/takt/file_transfer.hpp"
#include "eds_parser/table/ids.hpp"

namespace takt {

/// SDO transfers on a bus of this machine, without a daemon. Not beside a daemon on the same bus:
/// two SDO clients of one node confuse each other. Ctrl-C (Interrupt) aborts a transfer on the bus.
class SdoDirect {
 public:
  SdoDirect(std::string bus, NodeId node, Time timeout)
      : bus_{std::move(bus)}, node_{node}, timeout_{timeout} {}

  /// One value of a request's size.
  std::expected<std::vector<std::byte>, LiveError> upload(ObjectKey object);
  /// A file, by block transfer. A device that sends more than `limit` bytes is ended by an abort.
  std::expected<std::vector<std::byte>, LiveError> upload(ObjectKey object, std::size_t limit,
                                                          const Progress& progress);
  std::expected<void, LiveError> download(ObjectKey object, std::span<const std::byte> value,
                                          Progress progress = {});

 private:
  std::string bus_;
  NodeId node_;
  Time timeout_;
};

}  // namespace takt
