#pragma once
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <vector>

#include "test/unit/master/motion/judge.hpp"
#include "test/unit/master/motion/random_tasks.hpp"
#if TAKT_RUCKIG
#include "test/motion/ruckig_planner.hpp"
#endif

namespace takt::motion {

/// Results of the tasks of one class. They lie in memory that survives a crash of the process that
/// writes them.
struct Seen {
  std::uint64_t tasks = 0;
  std::uint64_t refused = 0;   ///< too few digits; permitted only for wide limits
  std::uint64_t wrong = 0;     ///< failures of takt
  std::uint64_t compared = 0;  ///< ruckig has a result that keeps the limits and ends at the target
  std::uint64_t crashes = 0;   ///< of ruckig
  double takt_seconds = 0.0;   ///< of processor time, for all tasks
  double other_seconds = 0.0;  ///< of ruckig, for the same tasks
  double end_error = 0.0;      ///< the largest of the motions that are not wrong
  double excess = 0.0;         ///< the largest of these motions, beyond a limit
  double late = 0.0;  ///< how much longer a motion is than that of ruckig: s / (1 s + its duration)

  // State of the block that runs:
  std::uint64_t next = 0;   ///< first task that is not judged yet
  std::uint64_t asked = 0;  ///< the task that ruckig plans at present
  std::uint64_t crashed_at_size = 0;
  std::array<std::uint64_t, 200> crashed_at{};  ///< tasks at which ruckig has crashed

  bool crashes_other(std::uint64_t task) const {
    const auto known = std::span{crashed_at}.first(crashed_at_size);
    return std::ranges::find(known, task) != known.end();
  }
};

inline double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Prints a failure with a request of `takt trajectory` that shows it.
inline void print_failure(const AxisTask& task, const char* why, double number) {
  const Limits& l = task.limits;
  std::printf(
      "FAILED %s %.3g: {\"from\":{\"position\":[%.17g],\"velocity\":[%.17g],"
      "\"acceleration\":[%.17g]},\"to\":{\"position\":[%.17g],\"velocity\":[%.17g],"
      "\"acceleration\":[%.17g]},\"limits\":{\"velocity\":[%.17g],\"min_velocity\":[%.17g],"
      "\"acceleration\":[%.17g],\"min_acceleration\":[%.17g],\"jerk\":[%.17g]}}\n",
      why, number, task.from.position, task.from.velocity, task.from.acceleration, task.to.position,
      task.to.velocity, task.to.acceleration, l.max_velocity, l.min_velocity, l.max_acceleration,
      l.min_acceleration, l.jerk);
  std::fflush(stdout);
}

/// Plans the tasks of one block with takt and with ruckig, and judges them.
class TaskBlock {
 public:
  static constexpr std::size_t size = 100'000;
  static constexpr std::size_t batch = 1'000;  ///< tasks that are timed together

  TaskBlock(TaskClass which, std::uint64_t seed, std::size_t tasks, Seen& seen)
      : which_{which}, random_{seed}, tasks_{tasks}, seen_{seen} {}

  /// Continues with the batch in which the process before this one has crashed.
  void run() {
    for (std::size_t begin = 0; begin < tasks_; begin += batch) {
      const std::size_t end = std::min(begin + batch, tasks_);
      batch_.clear();
      for (std::size_t i = begin; i < end; ++i) batch_.push_back(random_.next(which_));
      if (begin < seen_.next) continue;
      run_batch(begin);
      seen_.next = end;
    }
  }

 private:
  struct Answer {
    std::expected<double, Refused> duration;
    PlannedAxis planned;
  };

  void run_batch(std::size_t begin) {
    answers_.resize(batch_.size());
    const double started = processor_seconds();
    for (std::size_t i = 0; i < batch_.size(); ++i) {
      answers_[i].duration =
          plan_trajectory({&batch_[i], 1}, {}, std::span{&answers_[i].planned, 1});
    }
    const double ended = processor_seconds();
    ask_other(begin);
    seen_.other_seconds += processor_seconds() - ended;
    seen_.takt_seconds += ended - started;
    for (std::size_t i = 0; i < batch_.size(); ++i) judge(i);
  }

  void judge(std::size_t i) {
    const AxisTask& task = batch_[i];
    const Answer& answer = answers_[i];
    ++seen_.tasks;
    if (!answer.duration) {
      const Defect defect = answer.duration.error().defect;
      if (which_ != TaskClass::wide_limits || defect != Defect::precision) {
        return fail(task, "refused", static_cast<double>(defect));
      }
      ++seen_.refused;
      return;
    }
    const double duration = *answer.duration;
    const Judge judge{task, answer.planned.profile.segments()};
    const auto [error, excess] = judge.verdict();
    // A start far outside its limits may need months of one cruise, which cost digits.
    const double allowed = 1e-15 * std::max(duration, 1e6);
    if (!(error <= std::max(1e-8, allowed))) return fail(task, "end error", error);
    if (!(excess <= std::max(1e-9, allowed))) return fail(task, "excess", excess);
    if (duration < 1e6) {
      seen_.end_error = std::max(seen_.end_error, error);
      seen_.excess = std::max(seen_.excess, excess);
    }
    compare(i, duration);
  }

  void fail(const AxisTask& task, const char* why, double number) {
    ++seen_.wrong;
    if (seen_.wrong <= 20) print_failure(task, why, number);
  }

#if TAKT_RUCKIG
  void ask_other(std::size_t begin) {
    others_.resize(batch_.size());
    has_other_.assign(batch_.size(), false);
    for (std::size_t i = 0; i < batch_.size(); ++i) {
      if (seen_.crashes_other(begin + i)) continue;
      seen_.asked = begin + i;
      has_other_[i] = other_.plan(batch_[i], others_[i]);
    }
  }

  void compare(std::size_t i, double duration) {
    if (!has_other_[i]) return;
    const auto segments = segments_of(others_[i]);
    const Judge judge{batch_[i], segments};
    if (!(judge.verdict().end_error <= 1e-8 && judge.verdict().excess <= 1e-9)) return;
    ++seen_.compared;
    const double other = others_[i].get_duration();
    seen_.late = std::max(seen_.late, (duration - other) / (1.0 + other));
    if (which_ == TaskClass::wide_limits) return;  // has no digits left for this
    if (duration > other + 1e-9 + 1e-9 * other) fail(batch_[i], "slower by", duration - other);
  }

  RuckigPlanner other_;
  std::vector<RuckigPlanner::Trajectory> others_;
  std::vector<bool> has_other_;
#else
  void ask_other(std::size_t) {}
  void compare(std::size_t, double) {}
#endif

  TaskClass which_;
  RandomTasks random_;
  std::size_t tasks_;
  Seen& seen_;
  std::vector<AxisTask> batch_;
  std::vector<Answer> answers_;
};

}  // namespace takt::motion
