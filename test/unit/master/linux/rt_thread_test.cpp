#include "master/linux/rt_thread.hpp"

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/resource.h>
#include <thread>
#include <utility>

namespace takt {
namespace {

/// Runs a thread to its end.
RtReport run(const RealtimeOptions& options, std::function<void()> body) {
  RtReport report;
  auto thread = start_rt_thread(options, "takt-test", report, std::move(body));
  EXPECT_TRUE(thread);
  if (thread) thread->join();
  return report;
}

TEST(RtThread, OffAsksForNothingAndIsComplete) {
  bool ran = false;
  int policy = -1;

  const RtReport report = run({.mode = RtMode::off, .cpu = {}}, [&] {
    ran = true;
    policy = sched_getscheduler(0);
  });

  EXPECT_TRUE(ran);
  EXPECT_EQ(policy, SCHED_OTHER);
  EXPECT_TRUE(report.complete());
  EXPECT_TRUE(to_string(report).starts_with("off, kernel PREEMPT_RT: "));
}

TEST(RtThread, EnforceDoesNotRunTheBodyOnAProcessorThatIsNotThere) {
  bool ran = false;

  const RtReport report = run({.mode = RtMode::enforce, .cpu = 1000}, [&] { ran = true; });

  EXPECT_FALSE(ran);
  EXPECT_FALSE(report.may_run());
  EXPECT_NE(to_string(report).find("cpu 1000: "), std::string::npos);
}

TEST(RtThread, TryRunsTheBodyWhateverIsMissing) {
  bool ran = false;

  const RtReport report = run({.mode = RtMode::attempt, .cpu = 1000}, [&] { ran = true; });

  EXPECT_TRUE(ran);
  EXPECT_FALSE(report.complete());
}

int niceness() { return getpriority(PRIO_PROCESS, 0); }

TEST(PreferredThread, ComesBeforeOrdinaryOnesAndMakesOrdinaryThreads) {
  bool granted = false;
  int of_thread = 0;
  int of_its_thread = 0;
  std::thread{[&] {
    granted = prefer_this_thread();
    of_thread = niceness();
    std::thread{[&] { of_its_thread = niceness(); }}.join();
  }}.join();

  EXPECT_EQ(of_thread, granted ? -20 : niceness());
  EXPECT_GE(of_its_thread, 0);
}

TEST(RtThread, TheReportNamesWhatWasGranted) {
  const RtReport report{.mode = RtMode::attempt,
                        .priority = 80,
                        .cpu = 1,
                        .memory_locked = true,
                        .preempt_rt = false,
                        .missing = {}};

  EXPECT_EQ(to_string(report), "SCHED_FIFO 80 on cpu 1, memory locked, kernel PREEMPT_RT: no");
}

TEST(RtThread, TheReportNamesWhatIsMissingAndWhatGrantsIt) {
  RtReport report;
  report.missing = {"SCHED_FIFO 80: Operation not permitted (RLIMIT_RTPRIO is 0)"};

  EXPECT_EQ(to_string(report),
            "ordinary scheduling on any cpu, memory not locked, kernel PREEMPT_RT: no; missing: "
            "SCHED_FIFO 80: Operation not permitted (RLIMIT_RTPRIO is 0)");
}

}  // namespace
}  // namespace takt
