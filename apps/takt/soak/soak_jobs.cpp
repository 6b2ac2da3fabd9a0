#include "apps/takt/soak/soak_jobs.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <sys/wait.h>
#include <type_traits>
#include <unistd.h>
#include <vector>

#include "apps/takt/soak/front_run.hpp"
#include "apps/takt/soak/homing_run.hpp"

namespace takt::soak {
namespace {

/// A message that a worker writes into the pipe. It is shorter than PIPE_BUF, so that it arrives in
/// one piece.
struct Record {
  std::uint32_t worker = 0;
  bool begins = false;
  std::uint64_t seed = 0;
  SoakCounts counts{};
  std::uint64_t cycle = 0;
  Time when{};
  std::array<char, 64> invariant{};  ///< empty if the run was good
  std::array<char, 256> what{};

  SoakOutcome outcome() const {
    SoakOutcome outcome{counts, seed};
    if (invariant[0] != 0) {
      outcome.violation = {
          .cycle = cycle, .when = when, .invariant = invariant.data(), .what = what.data()};
    }
    return outcome;
  }
};
static_assert(std::is_trivially_copyable_v<Record> && sizeof(Record) <= 512);

template <std::size_t N>
void copy_text(std::array<char, N>& to, const std::string& from) {
  std::memcpy(to.data(), from.data(), std::min(from.size(), N - 1));
}

Record record_of(std::uint32_t worker, const SoakOutcome& outcome) {
  Record record{.worker = worker, .seed = outcome.seed, .counts = outcome};
  if (outcome.violation) {
    record.cycle = outcome.violation->cycle;
    record.when = outcome.violation->when;
    copy_text(record.invariant, outcome.violation->invariant);
    copy_text(record.what, outcome.violation->what);
  }
  return record;
}

bool put(int pipe, const Record& record) {
  return ::write(pipe, &record, sizeof record) == static_cast<ssize_t>(sizeof record);
}

/// Runs the bus part, the front part, or both, as the plan says.
SoakOutcome run(const LoadedNetwork& network, const SoakPlan& plan, const SoakOptions& options) {
  if (plan.part == SoakPart::front) return soak_front(network, options);
  if (plan.part == SoakPart::homing) return soak_homing(network, options);
  SoakOutcome outcome = soak(network, options);
  if (plan.part == SoakPart::bus || outcome.violation) return outcome;
  const SoakOutcome front = soak_front(network, options);
  outcome += front;
  outcome.violation = front.violation;
  return outcome;
}

void work(const LoadedNetwork& network, const SoakPlan& plan, std::uint32_t worker, int pipe) {
  SoakOptions options = plan.run;
  for (options.seed = plan.first + worker; options.seed <= plan.last; options.seed += plan.jobs) {
    if (!put(pipe, {.worker = worker, .begins = true, .seed = options.seed})) return;
    if (!put(pipe, record_of(worker, run(network, plan, options)))) return;
  }
}

struct Worker {
  pid_t pid = 0;
  std::uint64_t seed = 0;  ///< seed of the run in progress; 0 means none
};

}  // namespace

void run_jobs(const LoadedNetwork& network, const SoakPlan& plan,
              const std::function<void(const SoakReport&)>& reported) {
  std::array<int, 2> ends{};
  if (::pipe(ends.data()) != 0) throw std::runtime_error{"can't create a pipe for the workers"};
  std::fflush(nullptr);
  std::vector<Worker> workers(plan.jobs);
  for (std::uint32_t i = 0; i < plan.jobs; ++i) {
    workers[i].pid = ::fork();
    if (workers[i].pid < 0) throw std::runtime_error{"can't create a process for a worker"};
    if (workers[i].pid != 0) continue;
    ::close(ends[0]);
    work(network, plan, i, ends[1]);
    ::_exit(0);
  }
  ::close(ends[1]);
  Record record;
  while (::read(ends[0], &record, sizeof record) == static_cast<ssize_t>(sizeof record)) {
    workers[record.worker].seed = record.begins ? record.seed : 0;
    if (!record.begins) reported({.outcome = record.outcome()});
  }
  ::close(ends[0]);
  for (const Worker& worker : workers) {
    int status = 0;
    ::waitpid(worker.pid, &status, 0);
    if (worker.seed != 0) {
      reported({.outcome = {{}, worker.seed, {}},
                .signal = WIFSIGNALED(status) ? WTERMSIG(status) : -1});
    }
  }
}

}  // namespace takt::soak
