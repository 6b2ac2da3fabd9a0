#pragma once
#include <cstdint>
#include <sys/random.h>

namespace takt {

/// Returns a random number in 1..2^63-1 from the kernel, for the session of a daemon and the
/// instance of a sender, so that no two of them coincide by chance.
inline std::int64_t random_number() {
  constexpr std::uint64_t positive = 0x7FFF'FFFF'FFFF'FFFF;
  while (true) {
    std::uint64_t number = 0;
    // A signal may interrupt the call. A call for 8 bytes returns all of them or none.
    if (::getrandom(&number, sizeof number, 0) != sizeof number) continue;
    if ((number & positive) != 0) return static_cast<std::int64_t>(number & positive);
  }
}

}  // namespace takt
