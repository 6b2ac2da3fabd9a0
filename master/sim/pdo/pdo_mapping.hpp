#pragma once
#include <array>
#include <cstdint>

#include "master/sim/dictionary/abort.hpp"
#include "master/sim/dictionary/object_store.hpp"

namespace takt::sim {

enum class PdoDirection : std::uint8_t { receive, transmit };

/// What a device allows in a PDO mapping.
struct MappingRules {
  PdoDirection direction = PdoDirection::transmit;
  std::uint8_t dummy_usage = 0;  ///< bit n is set if data type n may be a dummy in an RPDO
};

/// Checks whether the device allows a mapping entry (index << 16 | sub << 8 | bits). CiA 301,
/// 7.5.2.36 and .38.
Abort check_entry(const ObjectStore& store, const MappingRules& rules,
                  std::uint64_t entry) noexcept;

/// A compiled mapping, which holds the place of each object in the frame.
class PdoMapping {
 public:
  void clear() noexcept { count_ = bits_ = 0; }
  /// Returns false if there is no more room (64 entries, 64 bits).
  bool add(ObjectStore& store, std::uint64_t entry) noexcept;

  std::uint64_t pack() const noexcept;
  void unpack(std::uint64_t data) const noexcept;
  std::uint8_t bytes() const noexcept { return static_cast<std::uint8_t>((bits_ + 7) / 8); }

 private:
  struct Place {
    Object* object = nullptr;
    std::uint64_t mask = 0;
    std::uint8_t shift = 0;
  };
  std::uint8_t count_ = 0;  ///< number of places in use; a dummy object has no place
  std::uint8_t bits_ = 0;
  std::array<Place, 64> places_{};
};

}  // namespace takt::sim
