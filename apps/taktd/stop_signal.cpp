#include "apps/taktd/stop_signal.hpp"

#include <atomic>

namespace takt {
namespace {

std::atomic<int> stop_signals{0};
static_assert(std::atomic<int>::is_always_lock_free);

void count_signal(int) { stop_signals.fetch_add(1, std::memory_order_relaxed); }

}  // namespace

StopSignal::StopSignal() {
  struct sigaction action{};
  action.sa_handler = count_signal;
  sigemptyset(&action.sa_mask);
  sigset_t stops;
  sigemptyset(&stops);
  for (const int number : {SIGTERM, SIGINT}) {
    sigaction(number, &action, nullptr);
    sigaddset(&stops, number);
  }
  pthread_sigmask(SIG_BLOCK, &stops, &wait_mask_);
  sigdelset(&wait_mask_, SIGTERM);
  sigdelset(&wait_mask_, SIGINT);
  std::signal(SIGPIPE, SIG_IGN);
}

int StopSignal::count() noexcept { return stop_signals.load(std::memory_order_relaxed); }

}  // namespace takt
