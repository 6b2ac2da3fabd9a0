#pragma once
#include <cstdint>

#include "master/motion/beat/axis_report.hpp"

namespace takt::motion {

/// The values of a beat that show the progress of homing.
struct HomingSigns {
  bool heard = false;   ///< the node of the drive exchanges PDOs
  bool fresh = false;   ///< the statusword has arrived
  bool homing = false;  ///< homing mode, enabled, and bit 4 of the controlword is set
  std::uint16_t statusword = 0;
};

/// Finds out from the homing runs of a drive whether the drive knows its home position. CiA 402-2,
/// homing mode: bits 10, 12 and 13 of the statusword.
class HomingWatch {
 public:
  /// In the first beats of a run, a drive may still show the result of an earlier run, so the
  /// result of this run is not known yet. A result that does not change for `patience` beats is
  /// that of this run.
  explicit HomingWatch(std::uint32_t patience) noexcept : patience_{patience} {}

  /// Takes the signs of a beat. The home position counts as lost when the node exchanges no PDOs
  /// any longer, because the device may have been switched off.
  HomingState step(const HomingSigns& signs) noexcept {
    if (!signs.heard) {
      phase_ = Phase::none;
      return state_ = HomingState::none;
    }
    if (!signs.fresh) return state_;
    if (!signs.homing) {
      if (state_ == HomingState::runs) state_ = HomingState::none;
      phase_ = Phase::none;
      return state_;
    }
    return step_run(signs.statusword);
  }

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(state_, phase_, first_, beats_);
  }

 private:
  enum class Phase : std::uint8_t {
    none,   ///< no run
    begun,  ///< the statusword may be that of an earlier run
    runs,   ///< the statusword is that of this run
  };
  static constexpr std::uint16_t target_reached = 0x0400;
  static constexpr std::uint16_t attained = 0x1000;
  static constexpr std::uint16_t error = 0x2000;

  HomingState step_run(std::uint16_t statusword) noexcept {
    const auto result = static_cast<std::uint16_t>(statusword & (attained | error));
    if (phase_ == Phase::none) {
      phase_ = Phase::begun;
      first_ = result;
      beats_ = 0;
    }
    if (phase_ == Phase::begun && (result == 0 || result != first_ || ++beats_ > patience_)) {
      phase_ = Phase::runs;
    }
    if (phase_ == Phase::begun) return state_ = HomingState::runs;
    if ((result & error) != 0) return state_ = HomingState::failed;
    const bool done = result == attained && (statusword & target_reached) != 0;
    return state_ = done ? HomingState::homed : HomingState::runs;
  }

  std::uint32_t patience_;
  HomingState state_ = HomingState::none;
  Phase phase_ = Phase::none;
  std::uint16_t first_ = 0;  ///< result bits in the first beat of the run
  std::uint32_t beats_ = 0;  ///< beats of the run in which the result bits have not changed
};

}  // namespace takt::motion
