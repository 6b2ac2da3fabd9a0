#include "test/proof/syscall_trap.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace takt::proof {
namespace {

#if defined(__x86_64__)
constexpr unsigned architecture = AUDIT_ARCH_X86_64;
#elif defined(__aarch64__)
constexpr unsigned architecture = AUDIT_ARCH_AARCH64;
#endif

// exit_group and rt_sigreturn let the report below end the process; clock_gettime is a vDSO read
// on most kernels and a system call on a few.
constexpr std::array<int, 7> allowed{SYS_clock_nanosleep, SYS_recvmmsg, SYS_sendmmsg,  SYS_ppoll,
                                     SYS_clock_gettime,   SYS_write,    SYS_exit_group};

void report(int, siginfo_t* info, void*) {
  std::array<char, 64> text{};
  const int length = std::snprintf(text.data(), text.size(),
                                   "trapped on the bus thread: system call %d\n", info->si_syscall);
  [[maybe_unused]] const ssize_t written =
      write(STDERR_FILENO, text.data(), static_cast<std::size_t>(length));
  _exit(syscall_exit);
}

[[noreturn]] void give_up(const char* what) {
  std::perror(what);
  std::_Exit(1);
}

sock_filter statement(unsigned code, unsigned value) {
  return {.code = static_cast<std::uint16_t>(code), .jt = 0, .jf = 0, .k = value};
}

sock_filter jump_if_equal(unsigned value, std::uint8_t yes, std::uint8_t no) {
  return {.code = BPF_JMP | BPF_JEQ | BPF_K, .jt = yes, .jf = no, .k = value};
}

}  // namespace

void trap_system_calls() {
  struct sigaction action{};
  action.sa_sigaction = report;
  action.sa_flags = SA_SIGINFO;
  if (sigaction(SIGSYS, &action, nullptr) != 0) give_up("sigaction");

  std::array<sock_filter, allowed.size() + 6> program{};
  std::size_t n = 0;
  program[n++] = statement(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, arch));
  program[n++] = jump_if_equal(architecture, 1, 0);
  program[n++] = statement(BPF_RET | BPF_K, SECCOMP_RET_KILL_PROCESS);
  program[n++] = statement(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr));
  for (std::size_t i = 0; i < allowed.size(); ++i) {
    const auto to_allow = static_cast<std::uint8_t>(allowed.size() - i);
    program[n++] = jump_if_equal(static_cast<unsigned>(allowed[i]), to_allow, 0);
  }
  program[n++] = statement(BPF_RET | BPF_K, SECCOMP_RET_TRAP);
  program[n++] = statement(BPF_RET | BPF_K, SECCOMP_RET_ALLOW);

  const sock_fprog filter{.len = static_cast<unsigned short>(n), .filter = program.data()};
  if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) give_up("PR_SET_NO_NEW_PRIVS");
  if (prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &filter) != 0) give_up("PR_SET_SECCOMP");
}

}  // namespace takt::proof
