#pragma once
#include <cstdint>

namespace takt {

/// Returns a random number in 1..2^63-1 from the kernel, for the session of a daemon and the
/// instance of a sender, so that no two of them coincide by chance.
std::int64_t random_number();

}  // namespace takt
