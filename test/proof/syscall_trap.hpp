#pragma once

namespace takt::proof {

/// From now on the calling thread may only sleep, receive, send and poll; every other system call
/// ends the process: it reports the number and exits with this code. Cannot be taken back.
inline constexpr int syscall_exit = 98;
void trap_system_calls();

}  // namespace takt::proof
