/* Preloaded into user-mode-linux where the host has more register state than UML's buffer holds
 * (AMX, since Intel's Sapphire Rapids: 11 kB).
 *
 * UML 6.1 keeps the registers of its processes in a buffer of a fixed size and moves them with
 * PTRACE_GETREGSET and PTRACE_SETREGSET of NT_X86_XSTATE. The host returns a part of the state on
 * request, but refuses to set less than the whole state: UML then panics in put_fp_registers before
 * its first process runs. Therefore this library sets a part in two steps: it reads the whole state
 * from the host, replaces its beginning by UML's part, and sets the whole state. The registers that
 * UML does not know (the AMX tiles) keep their values, which is right as long as no program in the
 * guest uses them.
 *
 * On a processor without AMX the same path works too, and costs one more system call each time.
 */
#include <dlfcn.h>
#include <elf.h>
#include <stdarg.h>
#include <string.h>
#include <sys/ptrace.h>
#include <sys/types.h>
#include <sys/uio.h>

typedef long Ptrace(enum __ptrace_request, pid_t, void*, void*);

static Ptrace* of_the_system(void) {
  static Ptrace* found;
  if (!found) *(void**)&found = dlsym(RTLD_NEXT, "ptrace");
  return found;
}

/* UML calls this from one thread only. */
static long move_registers(enum __ptrace_request request, pid_t process, void* set,
                           struct iovec* part) {
  static unsigned char whole[1 << 16];
  struct iovec host = {whole, sizeof whole};
  const long result = of_the_system()(PTRACE_GETREGSET, process, set, &host);
  if (result < 0) return result;
  if (part->iov_len > host.iov_len) part->iov_len = host.iov_len;
  if (request == PTRACE_GETREGSET) {
    memcpy(part->iov_base, whole, part->iov_len);
    return result;
  }
  memcpy(whole, part->iov_base, part->iov_len);
  return of_the_system()(PTRACE_SETREGSET, process, set, &host);
}

long ptrace(enum __ptrace_request request, ...) {
  va_list arguments;
  va_start(arguments, request);
  const pid_t process = va_arg(arguments, pid_t);
  void* const address = va_arg(arguments, void*);
  void* const data = va_arg(arguments, void*);
  va_end(arguments);
  const int moves = request == PTRACE_GETREGSET || request == PTRACE_SETREGSET;
  if (moves && (long)address == NT_X86_XSTATE)
    return move_registers(request, process, address, data);
  return of_the_system()(request, process, address, data);
}
