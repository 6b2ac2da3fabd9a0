#pragma once
#include <expected>

#include "master/linux/bus_error.hpp"
#include "master/linux/bus_name.hpp"
#include "master/linux/file_descriptor.hpp"

namespace takt {

/// The right to be the master of a bus. Within a network namespace, one process has it as long as
/// this object lives. The object holds an abstract unix socket, which the kernel releases however
/// the process ends. A simulated bus belongs to one process and is never refused.
class BusClaim {
 public:
  /// The error names the process that is the master.
  static std::expected<BusClaim, BusError> take(const BusName& bus);

 private:
  explicit BusClaim(FileDescriptor socket) noexcept : socket_{std::move(socket)} {}

  FileDescriptor socket_;
};

}  // namespace takt
