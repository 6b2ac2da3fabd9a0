#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "eds_parser/table/ids.hpp"
#include "eds_parser/table/time.hpp"
#include "master/sim/abort.hpp"

namespace takt::sim {

/// What is wrong with a device at the moment.
struct DeviceFaults {
  /// SDO access to one object that is refused or not answered.
  struct Access {
    ObjectKey key;
    Abort refusal = Abort::none;  ///< none: mute
  };

  bool mute_sdo = false;
  bool mute_pdo = false;
  bool no_bootup = false;
  bool no_heartbeat = false;
  bool self_start = false;
  bool fixed_mapping = false;
  Time bootup_delay{};
  Time storm_period{};  ///< of boot-up messages; 0 = no storm

  void add(Access access) noexcept {
    if (count_ < accesses_.size()) accesses_[count_++] = access;
  }
  void remove(ObjectKey key) noexcept {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      if (accesses_[i].key != key) accesses_[kept++] = accesses_[i];
    }
    count_ = kept;
  }
  std::optional<Access> find(ObjectKey key) const noexcept {
    for (std::size_t i = 0; i < count_; ++i) {
      if (accesses_[i].key == key) return accesses_[i];
    }
    return std::nullopt;
  }

 private:
  std::array<Access, 32> accesses_{};
  std::size_t count_ = 0;
};

}  // namespace takt::sim
