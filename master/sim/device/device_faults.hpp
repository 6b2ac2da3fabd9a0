#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "eds_parser/values/ids.hpp"
#include "eds_parser/values/time.hpp"
#include "master/sim/dictionary/abort.hpp"
#include "master/sim/service/guarding.hpp"
#include "master/sim/service/sdo_faults.hpp"

namespace takt::sim {

/// The faults that are active in a device.
struct DeviceFaults {
  /// Effect of a fault on SDO access to one object.
  enum class Answer : std::uint8_t { mute, refuse, refuse_write, ignore_write };
  struct Access {
    ObjectKey key;
    Answer answer = Answer::mute;
    Abort refusal = Abort::none;
  };

  bool mute_sdo = false;
  bool mute_pdo = false;
  bool no_bootup = false;
  bool no_heartbeat = false;
  GuardingResponder::Fault guarding = GuardingResponder::Fault::none;
  bool self_start = false;
  bool no_start = false;
  bool preop_only = false;
  bool fixed_mapping = false;
  SdoFaults sdo{};
  Time bootup_delay{};
  Time sdo_delay{};     ///< longest extra delay of an answer
  Time storm_period{};  ///< period of boot-up messages; 0 means no storm

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
  bool is_mute(ObjectKey key) const noexcept {
    const auto access = find(key);
    return access && access->answer == Answer::mute;
  }
  Abort on_read(ObjectKey key) const noexcept {
    const auto access = find(key);
    return access && access->answer == Answer::refuse ? access->refusal : Abort::none;
  }
  Abort on_write(ObjectKey key) const noexcept {
    const auto access = find(key);
    return access && access->answer != Answer::ignore_write ? access->refusal : Abort::none;
  }
  bool ignores_write(ObjectKey key) const noexcept {
    const auto access = find(key);
    return access && access->answer == Answer::ignore_write;
  }

 private:
  std::optional<Access> find(ObjectKey key) const noexcept {
    for (std::size_t i = 0; i < count_; ++i) {
      if (accesses_[i].key == key) return accesses_[i];
    }
    return std::nullopt;
  }

  std::array<Access, 32> accesses_{};
  std::size_t count_ = 0;
};

}  // namespace takt::sim
