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
#include <vector>

namespace takt::proof {
namespace {

#if defined(__x86_64__)
constexpr unsigned architecture = AUDIT_ARCH_X86_64;
#elif defined(__aarch64__)
constexpr unsigned architecture = AUDIT_ARCH_AARCH64;
#endif

// The reports of the traps need write and exit_group. clock_gettime is a vDSO read on most kernels,
// but a system call on a few.
constexpr std::array<SystemCall, 7> allowed{{
    {SYS_clock_nanosleep},
    {SYS_recvmmsg},
    {SYS_sendmmsg},
    {SYS_ppoll},
    {SYS_clock_gettime},
    {SYS_write, 0, STDERR_FILENO},
    {SYS_exit_group},
}};

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

sock_filter load(std::size_t offset) {
  return statement(BPF_LD | BPF_W | BPF_ABS, static_cast<unsigned>(offset));
}

/// Appends statements that allow this call. For another call, the program continues after these
/// statements.
void append(std::vector<sock_filter>& program, const SystemCall& call) {
  const bool any = call.argument < 0;
  program.push_back(load(offsetof(seccomp_data, nr)));
  program.push_back(jump_if_equal(static_cast<unsigned>(call.number), 0, any ? 1 : 3));
  if (!any) {  // the lower 32 bits come first
    const auto i = static_cast<std::size_t>(call.argument);
    program.push_back(load(offsetof(seccomp_data, args) + i * sizeof(seccomp_data::args[0])));
    program.push_back(jump_if_equal(call.value, 0, 1));
  }
  program.push_back(statement(BPF_RET | BPF_K, SECCOMP_RET_ALLOW));
}

}  // namespace

void trap_system_calls(std::span<const SystemCall> also) {
  struct sigaction action{};
  action.sa_sigaction = report;
  action.sa_flags = SA_SIGINFO;
  if (sigaction(SIGSYS, &action, nullptr) != 0) give_up("sigaction");

  std::vector<sock_filter> program{load(offsetof(seccomp_data, arch)),
                                   jump_if_equal(architecture, 1, 0),
                                   statement(BPF_RET | BPF_K, SECCOMP_RET_KILL_PROCESS)};
  for (const SystemCall& call : allowed) append(program, call);
  for (const SystemCall& call : also) append(program, call);
  program.push_back(statement(BPF_RET | BPF_K, SECCOMP_RET_TRAP));

  const sock_fprog filter{.len = static_cast<unsigned short>(program.size()),
                          .filter = program.data()};
  if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) give_up("PR_SET_NO_NEW_PRIVS");
  if (prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &filter) != 0) give_up("PR_SET_SECCOMP");
}

}  // namespace takt::proof
