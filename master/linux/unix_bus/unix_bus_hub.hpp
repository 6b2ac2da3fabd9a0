#pragma once
#include <expected>
#include <memory>
#include <string>

#include "master/linux/bus_error.hpp"

namespace takt {

/// The wire of `unix:PATH`. Every process on the bus owns a hub, except guests that found a host
/// when they joined. Exactly one of them, the holder of the lock file PATH.lock, listens on PATH
/// and hands each frame to all others, and back to its sender as an echo. When that process ends,
/// however it ends, another one takes over within 20 ms. If it ends in order, the frames that it
/// has taken still arrive.
///
/// A client that does not read loses frames (each later frame carries the number lost) and never
/// blocks the bus. At most 64 clients.
class UnixBusHub {
 public:
  /// Hosts the bus at once if no other process does; otherwise waits until the host ends. Runs one
  /// thread of ordinary priority.
  static std::expected<UnixBusHub, BusError> join(const std::string& path);
  UnixBusHub(UnixBusHub&&) noexcept;
  UnixBusHub& operator=(UnixBusHub&&) noexcept;
  ~UnixBusHub();

  bool hosting() const noexcept;

 private:
  class Impl;
  explicit UnixBusHub(std::unique_ptr<Impl> impl) noexcept;
  std::unique_ptr<Impl> impl_;
};

}  // namespace takt
