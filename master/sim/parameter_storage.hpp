#pragma once
#include <cstdint>

#include "master/sim/abort.hpp"
#include "master/sim/object_store.hpp"

namespace takt::sim {

/// 0x1010 store and 0x1011 restore parameters. CiA 301, 7.5.2.13 and .14.
class ParameterStorage {
 public:
  explicit ParameterStorage(ObjectStore& store) : store_{store} {}

  static bool owns(ObjectKey key) noexcept {
    return (key.index == 0x1010 || key.index == 0x1011) && key.sub != 0;
  }
  /// The signature is not kept: the objects go on telling what the device can do.
  Abort execute(ObjectKey key, std::uint64_t signature) noexcept;

 private:
  ObjectStore& store_;
};

}  // namespace takt::sim
