#pragma once
#include <cstdint>

namespace takt::proof {

/// While the trap is on, an allocation or a free by the calling thread ends the process. The
/// process reports the call and exits with this code.
inline constexpr int allocation_exit = 97;
void trap_allocations(bool on) noexcept;

/// Counts the allocations of the calling thread, without ending the process.
void count_allocations(bool on) noexcept;
std::uint64_t allocations() noexcept;

}  // namespace takt::proof
