#pragma once
#include <cstdint>

#include "master/sim/object_store.hpp"

namespace takt::sim {

/// What came in from the bus goes out again: entries `first` and up of `from` into those of `to`.
inline void echo(ObjectStore& store, std::uint16_t from, std::uint16_t to,
                 std::uint8_t first = 1) noexcept {
  for (const Object& in : store.range(from, from)) {
    Object* out = store.find({to, in.key.sub});
    if (in.key.sub >= first && out != nullptr) out->set(in.value);
  }
}

}  // namespace takt::sim
