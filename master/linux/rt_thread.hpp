#pragma once
#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "eds_parser/table/run_options.hpp"

namespace takt {

/// What the machine granted of the real time that was asked for.
struct RtReport {
  RtMode mode = RtMode::attempt;
  int priority = 0;                    ///< of SCHED_FIFO; 0: ordinary scheduling
  std::optional<int> cpu{};            ///< pinned to it
  bool memory_locked = false;          ///< now and in future
  bool preempt_rt = false;             ///< the kernel is a PREEMPT_RT one
  std::vector<std::string> missing{};  ///< each: what was refused, why, and what grants it

  /// Everything asked for was granted. (An ordinary kernel is reported but refuses nothing.)
  bool complete() const noexcept { return missing.empty(); }
  /// The thread may start: not under `enforce` with something missing.
  bool may_run() const noexcept { return mode != RtMode::enforce || complete(); }
};

/// `SCHED_FIFO 80 on cpu 1, memory locked, kernel PREEMPT_RT: no; missing: ...`. One line.
std::string to_string(const RtReport& report);

/// Gives the calling thread what `options` ask for: SCHED_FIFO, one CPU, locked memory (of the
/// whole process), its stack touched, no timer slack. Never fails: the report says what was
/// refused.
RtReport apply_realtime(const RealtimeOptions& options);

/// Lets the calling thread run before ordinary ones: nice -20, for the front thread. Unlike
/// SCHED_FIFO that leaves some time to everybody else, however much work comes from outside.
/// Threads that it starts are ordinary ones. False: the machine does not allow it (RLIMIT_NICE).
bool prefer_this_thread() noexcept;

/// Makes the heap keep what it has (no trimming, no mmap of single blocks) and touches `bytes` of
/// it, so that what is allocated later brings no page fault. Once, before the threads start.
void prefault_heap(std::size_t bytes);

/// A thread with real time applied before its body runs. Joins when destroyed: the owner makes the
/// body return first.
class RtThread {
 public:
  RtThread() = default;
  /// Returns when the report is known. The body runs only where report().may_run(). `name` is what
  /// `ps -L` shows, at most 15 characters.
  RtThread(const RealtimeOptions& options, const char* name, std::function<void()> body);

  const RtReport& report() const noexcept { return report_; }
  bool joinable() const noexcept { return thread_.joinable(); }
  void join() { thread_.join(); }

 private:
  RtReport report_;
  std::jthread thread_;
};

}  // namespace takt
