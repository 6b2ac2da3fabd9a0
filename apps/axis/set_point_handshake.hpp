#pragma once
#include <cstdint>

namespace takt {

/// Hands one profile position (pp) set-point to a drive: bit 4 of the controlword rises and stays
/// until statusword bit 12 acknowledges it, falls and stays until bit 12 has fallen. One step a
/// cycle; its bits are added to the controlword of DriveSequence. CiA 402-2, 4.1 handshake.
class SetPointHandshake {
 public:
  /// The target in 607A is new. While a handshake runs, it is repeated afterwards.
  void begin() noexcept;
  /// Bits 4 and 5 (new set-point, change at once) for this statusword.
  std::uint16_t step(std::uint16_t statusword) noexcept;
  bool done() const noexcept { return phase_ == Phase::idle && !again_; }

 private:
  enum class Phase : std::uint8_t { idle, before, raised, lowered };
  Phase phase_ = Phase::idle;
  bool again_ = false;
};

}  // namespace takt
