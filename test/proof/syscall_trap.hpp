#pragma once
#include <span>

namespace takt::proof {

/// A system call that is allowed. If `argument` is given, it is allowed only if this argument has
/// this value (32 bits).
struct SystemCall {
  int number;
  int argument = -1;
  unsigned value = 0;
};

/// From now on the calling thread may only sleep, receive, send and poll, and make the calls in
/// `also`. Every other system call ends the process, which reports the number of the call and exits
/// with this code. The trap cannot be removed.
inline constexpr int syscall_exit = 98;
void trap_system_calls(std::span<const SystemCall> also = {});

}  // namespace takt::proof
