#pragma once
#include <cstdint>

#include "master/sim/dictionary/abort.hpp"
#include "master/sim/dictionary/object_store.hpp"

namespace takt::sim {

/// The objects 0x1010 (store parameters) and 0x1011 (restore parameters). CiA 301, 7.5.2.13 and
/// .14.
class ParameterStorage {
 public:
  explicit ParameterStorage(ObjectStore& store) : store_{store} {}

  static bool owns(ObjectKey key) noexcept {
    return (key.index == 0x1010 || key.index == 0x1011) && key.sub != 0;
  }
  /// Stores or restores if the signature is right. The objects do not keep the signature; they
  /// still show the capabilities of the device.
  Abort execute(ObjectKey key, std::uint64_t signature) noexcept;

 private:
  ObjectStore& store_;
};

}  // namespace takt::sim
