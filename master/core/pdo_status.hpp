#pragma once
#include <cstdint>
#include <type_traits>

namespace takt {

/// What is known of one TPDO. Trivially copyable: it crosses threads.
struct PdoStatus {
  std::uint32_t received = 0;       ///< frames taken over
  std::uint32_t missing = 0;        ///< times it was expected and stayed away
  std::uint32_t late = 0;           ///< synchronous frames after their window
  std::uint32_t length_errors = 0;  ///< frames shorter (ignored) or longer than the mapping
  std::uint32_t too_long = 0;       ///< of these the longer ones; their first bytes were used
  std::uint32_t age = 0;            ///< SYNCs since the newest frame
  bool stale = true;                ///< not arrived when expected, or not at all so far
};
static_assert(std::is_trivially_copyable_v<PdoStatus>);

/// What is known of one RPDO. Trivially copyable: it crosses threads.
struct RpdoStatus {
  std::uint32_t sent = 0;
  bool ready = false;  ///< each of its signals has a value worth sending
};
static_assert(std::is_trivially_copyable_v<RpdoStatus>);

/// What one TPDO did since the image before.
struct PdoMark {
  static constexpr std::uint8_t arrived = 1;
  static constexpr std::uint8_t missing = 2;    ///< expected, or its deadline is over
  static constexpr std::uint8_t late = 4;       ///< came after its window
  static constexpr std::uint8_t too_short = 8;  ///< ignored whole; EMCY 8210 of a device
  static constexpr std::uint8_t too_long = 16;  ///< first bytes used; EMCY 8220 of a device

  std::uint32_t received = 0;  ///< frames taken over since the start
  std::uint32_t cycle = 0;     ///< of the newest frame, lowest 32 bits
  std::uint8_t flags = 0;

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(received, cycle, flags);
  }

  bool toggle() const noexcept { return (received & 1) != 0; }
  bool is(std::uint8_t flag) const noexcept { return (flags & flag) != 0; }
};
static_assert(sizeof(PdoMark) == 12 && std::is_trivially_copyable_v<PdoMark>);

}  // namespace takt
