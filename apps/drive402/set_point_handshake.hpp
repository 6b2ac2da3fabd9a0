#pragma once
#include <cstdint>
#include <takt/drive402.hpp>

namespace takt {

/// Hands one set-point of the profile position mode (pp) to a drive. Bit 4 of the controlword rises
/// and stays high until bit 12 of the statusword acknowledges it; then bit 4 falls and stays low
/// until bit 12 has fallen. There is one step in each cycle, and the caller adds its bits to the
/// controlword of DriveSequence. CiA 402-2, 4.1 handshake.
class SetPointHandshake {
 public:
  /// Starts a handshake for a new target in 0x607A. If a handshake is running, another one follows
  /// it.
  void begin(SetPointTiming timing = SetPointTiming::immediately) noexcept;
  /// Returns bits 4 and 5 of the controlword (new set-point, change at once) that answer this
  /// statusword. Bit 5 is set unless the set-point waits for the one before it.
  std::uint16_t step(std::uint16_t statusword) noexcept;
  /// Returns true if no handshake is running and none is to follow.
  bool done() const noexcept { return phase_ == Phase::idle && !again_; }
  /// Returns true if the drive has taken all set-points. Bit 12 of the statusword may still be set.
  bool taken() const noexcept {
    return (phase_ == Phase::idle || phase_ == Phase::lowered) && !again_;
  }

 private:
  enum class Phase : std::uint8_t { idle, before, raised, lowered };
  Phase phase_ = Phase::idle;
  bool again_ = false;
  SetPointTiming timing_ = SetPointTiming::immediately;
  // Timing of the handshake that follows.
  SetPointTiming next_timing_ = SetPointTiming::immediately;
};

}  // namespace takt
