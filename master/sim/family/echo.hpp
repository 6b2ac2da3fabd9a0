#pragma once
#include <cstdint>

#include "master/sim/dictionary/object_store.hpp"

namespace takt::sim {

/// Sub-index of the first process word of an inverter after the control or status word and the
/// speed.
inline constexpr std::uint8_t first_free_word = 3;

/// Copies received values to objects that the device sends: the sub-indices from `first` on of
/// `from` to the same sub-indices of `to`.
inline void echo(ObjectStore& store, std::uint16_t from, std::uint16_t to,
                 std::uint8_t first = 1) noexcept {
  for (const Object& in : store.range(from, from)) {
    Object* out = store.find({to, in.key.sub});
    if (in.key.sub >= first && out != nullptr) out->set(in.value);
  }
}

}  // namespace takt::sim
