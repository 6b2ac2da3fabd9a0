#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "master/sim/abort.hpp"
#include "master/sim/object_store.hpp"

namespace takt::sim {

enum class PdoDirection : std::uint8_t { receive, transmit };

/// What a device lets be mapped.
struct MappingRules {
  PdoDirection direction = PdoDirection::transmit;
  std::uint8_t dummy_usage = 0;  ///< bit n: data type n may be a dummy in an RPDO
};

/// May this entry (index << 16 | sub << 8 | bits) be mapped? CiA 301, 7.5.2.36 and .38.
Abort check_entry(const ObjectStore& store, const MappingRules& rules,
                  std::uint64_t entry) noexcept;

/// A mapping ready to run: where each object lies in the frame.
class PdoMapping {
 public:
  void clear() noexcept { count_ = bits_ = 0; }
  /// False: no more room (64 entries, 64 bits).
  bool add(ObjectStore& store, std::uint64_t entry) noexcept;

  std::uint64_t pack() const noexcept;
  void unpack(std::uint64_t data) const noexcept;
  std::uint8_t bytes() const noexcept { return static_cast<std::uint8_t>((bits_ + 7) / 8); }

 private:
  struct Place {
    Object* object = nullptr;  ///< nullptr: a dummy
    std::uint64_t mask = 0;
    std::uint8_t shift = 0;
  };
  std::array<Place, 64> places_{};
  std::uint8_t count_ = 0;
  std::uint8_t bits_ = 0;
};

}  // namespace takt::sim
