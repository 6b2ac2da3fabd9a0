#pragma once
#include <expected>
#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "eds_parser/table/run_options.hpp"

namespace takt {

/// The requested real-time properties that the machine has granted, and those that it has refused.
struct RtReport {
  RtMode mode = RtMode::attempt;
  int priority = 0;            ///< SCHED_FIFO priority; 0 means ordinary scheduling
  std::optional<int> cpu{};    ///< the CPU that the thread is pinned to
  bool memory_locked = false;  ///< current and future memory is locked
  bool preempt_rt = false;     ///< the kernel is a PREEMPT_RT one
  /// One text per refusal: what was refused, why, and in most cases which setting grants it.
  std::vector<std::string> missing{};

  /// Returns true if every request was granted. (An ordinary kernel is reported, but refuses
  /// nothing.)
  bool complete() const noexcept { return missing.empty(); }
  /// Returns true if the thread may start; false under `enforce` if something is missing.
  bool may_run() const noexcept { return mode != RtMode::enforce || complete(); }
};

/// Returns one line, such as `SCHED_FIFO 80 on cpu 1, memory locked, kernel PREEMPT_RT: no;
/// missing: ...`.
std::string to_string(const RtReport& report);

/// Applies `options` to the calling thread: SCHED_FIFO, one CPU, locked memory (of the whole
/// process), a touched stack and no timer slack. Never fails: the report says what was refused.
RtReport apply_realtime(const RealtimeOptions& options);

/// Gives the calling thread precedence over ordinary ones (nice -20), for the front thread. Unlike
/// SCHED_FIFO, this leaves some time to all other threads, however much work comes from outside.
/// Threads that the calling thread starts are ordinary ones. Returns false if the machine does not
/// allow it (RLIMIT_NICE).
bool prefer_this_thread() noexcept;

/// Prepares the memory of the process. Call this function once, before any thread starts. From then
/// on, the heap returns no memory to the kernel, so that later allocations cause few page faults.
/// Each later thread has a stack of 512 KiB beside its thread-local variables, because locked
/// memory includes the whole stack, not only the part that the thread uses.
void prepare_memory();

/// Starts a thread with real-time properties, and returns when `report` contains what the machine
/// has granted. If the report does not permit the thread to run, the thread ends without calling
/// `body`. `name` appears in `ps -L` and has at most 15 characters. Returns the errno if the
/// machine refuses another thread.
std::expected<std::thread, int> start_rt_thread(const RealtimeOptions& options, const char* name,
                                                RtReport& report, std::function<void()> body);

}  // namespace takt
