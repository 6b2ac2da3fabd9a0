#pragma once
#include <cstdint>

namespace takt {

/// Returns the number of calls of operator new in this test program so far.
std::uint64_t allocations() noexcept;

}  // namespace takt
