/* Preloaded into user-mode-linux by its test. It imitates, on any processor, a host whose register
 * state is 11 kB, as with AMX.
 *
 * A caller may read any part of the state. A caller that sets the state has to set the whole state;
 * the host checks this, too.
 */
#include <dlfcn.h>
#include <elf.h>
#include <errno.h>
#include <stdarg.h>
#include <string.h>
#include <sys/ptrace.h>
#include <sys/types.h>
#include <sys/uio.h>

enum { large = 11008 };

typedef long Ptrace(enum __ptrace_request, pid_t, void*, void*);

static size_t smaller(size_t a, size_t b) { return a < b ? a : b; }

static long move_registers(Ptrace* system, enum __ptrace_request request, pid_t process, void* set,
                           struct iovec* part) {
  static unsigned char state[large];
  struct iovec host = {state, sizeof state};
  if (request == PTRACE_SETREGSET && part->iov_len < large) {
    errno = EFAULT;
    return -1;
  }
  const long result = system(PTRACE_GETREGSET, process, set, &host);
  if (result < 0) return result;
  if (request == PTRACE_SETREGSET) {
    memcpy(state, part->iov_base, host.iov_len);
    return system(PTRACE_SETREGSET, process, set, &host);
  }
  memset(state + host.iov_len, 0, large - host.iov_len);
  part->iov_len = smaller(part->iov_len, large);
  memcpy(part->iov_base, state, part->iov_len);
  return result;
}

long ptrace(enum __ptrace_request request, ...) {
  static Ptrace* system;
  va_list arguments;
  va_start(arguments, request);
  const pid_t process = va_arg(arguments, pid_t);
  void* const address = va_arg(arguments, void*);
  void* const data = va_arg(arguments, void*);
  va_end(arguments);
  if (!system) *(void**)&system = dlsym(RTLD_NEXT, "ptrace");
  const int moves = request == PTRACE_GETREGSET || request == PTRACE_SETREGSET;
  if (moves && (long)address == NT_X86_XSTATE)
    return move_registers(system, request, process, address, data);
  return system(request, process, address, data);
}
