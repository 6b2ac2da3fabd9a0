#pragma once
#include <cstdint>

namespace takt {

/// A random number in 1..2^63-1 from the kernel: for the session of a daemon and the instance of a
/// sender, which nobody else shall have by chance.
std::int64_t random_number();

}  // namespace takt
