#pragma once
#include <cstdint>

namespace takt::proof {

/// From now on an allocation or a free by the calling thread ends the process: it reports what it
/// was and exits with this code.
inline constexpr int allocation_exit = 97;
void trap_allocations(bool on) noexcept;

/// Allocations of the calling thread while counting, without ending anything.
void count_allocations(bool on) noexcept;
std::uint64_t allocations() noexcept;

}  // namespace takt::proof
