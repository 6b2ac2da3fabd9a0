#include "apps/taktd/stop_signal.hpp"

#include <atomic>

namespace takt {
namespace {

std::atomic<int> stop_signals{0};
static_assert(std::atomic<int>::is_always_lock_free);

std::atomic<bool> recording_wished{false};

void wish_recording(int) { recording_wished.store(true, std::memory_order_relaxed); }
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
  action.sa_handler = wish_recording;
  sigaction(SIGUSR1, &action, nullptr);
  sigaddset(&stops, SIGUSR1);
  pthread_sigmask(SIG_BLOCK, &stops, &wait_mask_);
  sigdelset(&wait_mask_, SIGTERM);
  sigdelset(&wait_mask_, SIGINT);
  sigdelset(&wait_mask_, SIGUSR1);
  std::signal(SIGPIPE, SIG_IGN);
}

bool StopSignal::take_recording_wish() noexcept {
  return recording_wished.exchange(false, std::memory_order_relaxed);
}

int StopSignal::count() noexcept { return stop_signals.load(std::memory_order_relaxed); }

}  // namespace takt
