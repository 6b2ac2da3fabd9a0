#pragma once
#include <expected>

#include "master/linux/bus_error.hpp"
#include "master/linux/bus_name.hpp"
#include "master/linux/file_descriptor.hpp"

namespace takt {

/// The right to be the master of a bus. One process of a network namespace has it, for as long as
/// this object lives: it holds an abstract unix socket, which the kernel takes away from a process
/// however that ends. A simulated bus belongs to one process anyhow and is never refused.
class BusClaim {
 public:
  /// An error says who the master is.
  static std::expected<BusClaim, BusError> take(const BusName& bus);

 private:
  explicit BusClaim(FileDescriptor socket) noexcept : socket_{std::move(socket)} {}

  FileDescriptor socket_;
};

}  // namespace takt
