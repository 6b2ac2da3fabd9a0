#include "apps/taktd/process/stop_signal.hpp"

#include <csignal>
#include <gtest/gtest.h>
#include <pthread.h>
#include <sys/wait.h>
#include <unistd.h>

namespace takt {
namespace {

/// Runs `body` in a child process, so that its signal handlers and counts end with the child.
template <class Body>
int in_a_child(Body body) {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(body());
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(StopSignal, BeginsTheStopWhileTheFrontThreadIsBusyWithSomethingElse) {
  const int result = in_a_child([] {
    std::atomic<bool> stop{false};
    const StopSignal signals;
    signals.let_through();
    StopSignal::stop_with(stop);
    ::raise(SIGTERM);
    return stop && StopSignal::count() == 1 ? 0 : 1;
  });

  EXPECT_EQ(result, 0);
}

TEST(StopSignal, BeginsTheStopOfAMasterThatIsMadeAfterTheSignal) {
  const int result = in_a_child([] {
    std::atomic<bool> stop{false};
    const StopSignal signals;
    ::kill(::getpid(), SIGTERM);
    if (StopSignal::count() != 0) return 1;  // the signal waits for let_through()
    signals.let_through();
    StopSignal::stop_with(stop);
    return stop ? 0 : 2;
  });

  EXPECT_EQ(result, 0);
}

TEST(StopSignal, BeginsTheStopOfEachMaster) {
  const int result = in_a_child([] {
    std::atomic<bool> first{false};
    std::atomic<bool> second{false};
    const StopSignal signals;
    signals.let_through();
    StopSignal::stop_with(first);
    StopSignal::stop_with(second);
    ::raise(SIGTERM);
    return first && second ? 0 : 1;
  });

  EXPECT_EQ(result, 0);
}

TEST(StopSignal, TouchesNothingOfAMasterThatIsGone) {
  const int result = in_a_child([] {
    std::atomic<bool> stop{false};
    const StopSignal signals;
    signals.let_through();
    StopSignal::stop_with(stop);
    StopSignal::forget_stops();
    ::raise(SIGTERM);
    return !stop && StopSignal::count() == 1 ? 0 : 1;
  });

  EXPECT_EQ(result, 0);
}

}  // namespace
}  // namespace takt
