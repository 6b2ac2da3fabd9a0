#pragma once
#include <cstdint>
#include <type_traits>

namespace takt {

/// Status of one TPDO. It is trivially copyable because it is passed between threads.
struct PdoStatus {
  std::uint32_t received = 0;  ///< accepted frames
  std::uint32_t missing = 0;   ///< number of cycles in which the TPDO was expected and did not come
  std::uint32_t late = 0;      ///< synchronous frames that came after their window
  std::uint32_t length_errors = 0;  ///< frames shorter (ignored) or longer than the mapping
  std::uint32_t too_long = 0;  ///< length errors with a longer frame; its first bytes were used
  std::uint32_t age = 0;       ///< SYNCs since the newest frame
  bool stale = true;  ///< the TPDO did not arrive when expected, or has not arrived at all so far
};
static_assert(std::is_trivially_copyable_v<PdoStatus>);

/// Status of one RPDO. It is trivially copyable because it is passed between threads.
struct RpdoStatus {
  std::uint32_t sent = 0;
  bool ready = false;  ///< each of its signals has a value that can be sent
};
static_assert(std::is_trivially_copyable_v<RpdoStatus>);

/// The frames of one TPDO since the previous image.
struct PdoMark {
  /// The TPDO has arrived.
  static constexpr std::uint8_t arrived = 1;
  /// The TPDO was expected and did not come, or its deadline is over.
  static constexpr std::uint8_t missing = 2;
  static constexpr std::uint8_t late = 4;  ///< the TPDO came after its window
  /// The frame was ignored; a device would send EMCY 0x8210.
  static constexpr std::uint8_t too_short = 8;
  /// The first bytes were used; a device would send EMCY 0x8220.
  static constexpr std::uint8_t too_long = 16;

  std::uint32_t received = 0;  ///< accepted frames since the start
  std::uint32_t cycle = 0;     ///< cycle of the newest frame, lowest 32 bits
  std::uint8_t flags = 0;

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(received, cycle, flags);
  }

  /// Returns a bit that changes with each accepted frame.
  bool toggle() const noexcept { return (received & 1) != 0; }
  bool is(std::uint8_t flag) const noexcept { return (flags & flag) != 0; }
};
static_assert(sizeof(PdoMark) == 12 && std::is_trivially_copyable_v<PdoMark>);

}  // namespace takt
