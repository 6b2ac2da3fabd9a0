#include "master/linux/rt_thread.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <future>
#include <link.h>
#include <linux/capability.h>
#include <malloc.h>
#include <pthread.h>
#include <sched.h>
#include <string_view>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/utsname.h>
#include <unistd.h>
#include <utility>

#include "master/linux/start_thread.hpp"

namespace takt {
namespace {

std::string error_text(int error) { return std::strerror(error); }

bool kernel_is_preempt_rt() {
  std::ifstream file{"/sys/kernel/realtime"};
  int value = 0;
  if (file >> value) return value == 1;
  utsname name{};
  uname(&name);
  return std::string_view{name.version}.find("PREEMPT_RT") != std::string_view::npos;
}

bool has_capability(unsigned capability) {
  __user_cap_header_struct header{.version = _LINUX_CAPABILITY_VERSION_3, .pid = 0};
  __user_cap_data_struct data[2]{};
  if (syscall(SYS_capget, &header, data) != 0) return false;
  return (data[capability / 32].effective >> (capability % 32) & 1) != 0;
}

/// Raises the soft limit to the hard limit and returns the limit then in force.
rlim_t raise_limit(__rlimit_resource resource) {
  rlimit limit{};
  getrlimit(resource, &limit);
  limit.rlim_cur = limit.rlim_max;
  setrlimit(resource, &limit);
  getrlimit(resource, &limit);
  return limit.rlim_cur;
}

void set_priority(int priority, RtReport& report) {
  const rlim_t limit = raise_limit(RLIMIT_RTPRIO);
  sched_param parameter{};
  parameter.sched_priority = priority;
  if (sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK, &parameter) == 0) {
    report.priority = priority;
    return;
  }
  report.missing.push_back("SCHED_FIFO " + std::to_string(priority) + ": " + error_text(errno) +
                           " (RLIMIT_RTPRIO is " + std::to_string(limit) +
                           "; systemd: LimitRTPRIO=99, else a line '@realtime - rtprio 99' in "
                           "/etc/security/limits.d or CAP_SYS_NICE)");
}

void pin(int cpu, RtReport& report) {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (cpu < 0 || cpu >= CPU_SETSIZE) {
    report.missing.push_back("cpu " + std::to_string(cpu) + ": this machine has no such processor");
    return;
  }
  CPU_SET(cpu, &set);
  if (sched_setaffinity(0, sizeof set, &set) == 0) {
    report.cpu = cpu;
    return;
  }
  report.missing.push_back(
      "cpu " + std::to_string(cpu) + ": " + error_text(errno) +
      " (this machine does not have it, or it is not in the cpuset of this process)");
}

/// Locks the memory of the process only if no limit applies to locked memory. Under a limit,
/// MCL_FUTURE could make a later allocation fail.
void lock_memory(RtReport& report) {
  const rlim_t limit = raise_limit(RLIMIT_MEMLOCK);
  if (limit == RLIM_INFINITY || has_capability(CAP_IPC_LOCK)) {
    if (mlockall(MCL_CURRENT | MCL_FUTURE) == 0) {
      report.memory_locked = true;
      return;
    }
    report.missing.push_back("locked memory: " + error_text(errno));
    return;
  }
  report.missing.push_back("locked memory: RLIMIT_MEMLOCK is " + std::to_string(limit / 1024) +
                           " KiB (systemd: LimitMEMLOCK=infinity, else a line '@realtime - memlock "
                           "unlimited' in /etc/security/limits.d or CAP_IPC_LOCK)");
}

[[gnu::noinline]] void prefault_stack() {
  constexpr std::size_t bytes = 256 * 1024;
  char room[bytes];
  volatile char* touched = room;
  for (std::size_t i = 0; i < bytes; i += 4096) touched[i] = 0;
}

/// Returns the bytes that the thread-local variables of the program and its libraries take of the
/// stack of each thread. ThreadSanitizer alone has more than 512 KiB.
std::size_t thread_local_bytes() {
  std::size_t bytes = 0;
  dl_iterate_phdr(
      [](dl_phdr_info* library, std::size_t, void* sum) {
        for (int i = 0; i < library->dlpi_phnum; ++i) {
          if (library->dlpi_phdr[i].p_type != PT_TLS) continue;
          *static_cast<std::size_t*>(sum) += library->dlpi_phdr[i].p_memsz;
        }
        return 0;
      },
      &bytes);
  return bytes;
}

}  // namespace

RtReport apply_realtime(const RealtimeOptions& options) {
  RtReport report;
  report.mode = options.mode;
  report.preempt_rt = kernel_is_preempt_rt();
  prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);
  prefault_stack();
  if (options.mode == RtMode::off) return report;
  lock_memory(report);
  if (options.cpu) pin(*options.cpu, report);
  set_priority(options.priority, report);
  return report;
}

bool prefer_this_thread() noexcept {
  constexpr int highest = -20;
  const sched_param ordinary{};
  return sched_setscheduler(0, SCHED_OTHER | SCHED_RESET_ON_FORK, &ordinary) == 0 &&
         setpriority(PRIO_PROCESS, 0, highest) == 0;
}

void prepare_memory() {
  constexpr std::size_t stack_bytes = 512 * 1024;
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, stack_bytes + thread_local_bytes());
  pthread_setattr_default_np(&attributes);
  pthread_attr_destroy(&attributes);
  mallopt(M_TRIM_THRESHOLD, -1);
  mallopt(M_MMAP_MAX, 0);
}

std::string to_string(const RtReport& report) {
  std::string text;
  if (report.mode == RtMode::off) {
    text = "off";
  } else {
    text = report.priority > 0 ? "SCHED_FIFO " + std::to_string(report.priority)
                               : std::string{"ordinary scheduling"};
    text += report.cpu ? " on cpu " + std::to_string(*report.cpu) : std::string{" on any cpu"};
    text += report.memory_locked ? ", memory locked" : ", memory not locked";
  }
  text += report.preempt_rt ? ", kernel PREEMPT_RT: yes" : ", kernel PREEMPT_RT: no";
  const char* separator = "; missing: ";
  for (const std::string& item : report.missing) {
    text += separator + item;
    separator = "; ";
  }
  return text;
}

std::expected<std::thread, int> start_rt_thread(const RealtimeOptions& options, const char* name,
                                                RtReport& report, std::function<void()> body) {
  std::promise<RtReport> promise;
  auto granted = promise.get_future();
  auto thread =
      start_thread([options, name, body = std::move(body), promise = std::move(promise)]() mutable {
        pthread_setname_np(pthread_self(), name);
        const RtReport own = apply_realtime(options);
        promise.set_value(own);
        if (own.may_run()) body();
      });
  if (thread) report = granted.get();
  return thread;
}

}  // namespace takt
