#pragma once
#include <span>

namespace takt::proof {

/// A system call that is allowed; where `argument` is given, only with this value of it (32 bits).
struct SystemCall {
  int number;
  int argument = -1;
  unsigned value = 0;
};

/// From now on the calling thread may only sleep, receive, send and poll, and what `also` names;
/// every other system call ends the process: it reports the number and exits with this code.
/// Cannot be taken back.
inline constexpr int syscall_exit = 98;
void trap_system_calls(std::span<const SystemCall> also = {});

}  // namespace takt::proof
