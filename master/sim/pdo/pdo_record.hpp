#pragma once
#include <cstdint>

#include "eds_parser/values/ids.hpp"
#include "eds_parser/values/time.hpp"
#include "master/sim/dictionary/abort.hpp"
#include "master/sim/dictionary/cob_rules.hpp"
#include "master/sim/dictionary/object_store.hpp"
#include "master/sim/pdo/pdo_mapping.hpp"

namespace takt::sim {

/// EMCY code: a frame is too short for the mapping of its PDO. CiA 301, table 26.
inline constexpr std::uint16_t too_short = 0x8210;

/// The addressing of the frames of a multiplexed PDO. CiA 301, 7.2.3.
enum class Multiplex : std::uint8_t { none, source, destination };

/// The communication and mapping objects of one PDO in the dictionary, and the checks of a device
/// when these objects are written. CiA 301, 7.5.2.35 to .38.
class PdoRecord {
 public:
  /// `number` counts from 1. The record may be used only if exists() is true.
  PdoRecord(ObjectStore& store, PdoDirection direction, std::uint16_t number);

  static bool exists(const ObjectStore& store, PdoDirection direction, std::uint16_t number);

  std::uint16_t number() const noexcept { return number_; }
  bool valid() const noexcept { return (cob_->value & cob_invalid) == 0; }
  bool rtr_allowed() const noexcept { return (cob_->value & cob_bit30) == 0; }
  CobId id() const noexcept { return cob_id(cob_->value); }
  std::uint16_t mapping_index() const noexcept {
    return static_cast<std::uint16_t>(communication_ + 0x200);
  }
  /// A PDO is multiplexed if sub-index 0 of its mapping is 0xFE or 0xFF instead of a number of
  /// entries.
  Multiplex multiplex() const noexcept {
    const std::uint64_t count = count_ == nullptr ? 0 : count_->value;
    if (count == source_mark) return Multiplex::source;
    return count == destination_mark ? Multiplex::destination : Multiplex::none;
  }
  std::uint8_t type() const noexcept {
    return type_ == nullptr ? 255 : static_cast<std::uint8_t>(type_->value);
  }
  bool synchronous() const noexcept { return type() <= 240 || type() == 252; }
  Time inhibit() const noexcept;
  /// Returns the event timer; for an RPDO, its deadline.
  Time event_timer() const noexcept {
    return std::chrono::milliseconds{timer_ == nullptr ? 0 : timer_->value};
  }
  std::uint8_t sync_start() const noexcept {
    return start_ == nullptr ? 0 : static_cast<std::uint8_t>(start_->value);
  }

  /// Returns true for the objects of this PDO: 0x1400.. or 0x1800.., and the mapping 0x200 above.
  bool owns(ObjectKey key) const noexcept {
    return key.index == communication_ || key.index == communication_ + 0x200;
  }
  Abort check_write(const MappingRules& rules, const Object& object,
                    std::uint64_t raw) const noexcept;
  /// Compiles the present mapping of the dictionary; the result is empty while sub-index 0 is 0.
  void compile(PdoMapping& mapping) const noexcept;

 private:
  static constexpr std::uint64_t source_mark = 0xFE;
  static constexpr std::uint64_t destination_mark = 0xFF;

  Abort check_cob(std::uint64_t raw) const noexcept;
  Abort check_type(PdoDirection direction, std::uint64_t raw) const noexcept;
  Abort check_count(const MappingRules& rules, std::uint64_t raw) const noexcept;

  ObjectStore& store_;
  std::uint16_t number_;
  std::uint16_t communication_;
  Object* cob_;
  Object* type_;
  Object* inhibit_;
  Object* timer_;
  Object* start_;
  Object* count_;
};

}  // namespace takt::sim
