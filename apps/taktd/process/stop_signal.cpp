#include "apps/taktd/process/stop_signal.hpp"

#include <array>

namespace takt {
namespace {

std::atomic<int> stop_signals{0};
static_assert(std::atomic<int>::is_always_lock_free);

std::atomic<bool> recording_requested{false};

constexpr std::array stop_numbers{SIGTERM, SIGINT, SIGHUP};

void request_recording(int) { recording_requested.store(true, std::memory_order_relaxed); }

std::array<std::atomic<std::atomic<bool>*>, StopSignal::most_requests> stop_requests{};
static_assert(std::atomic<std::atomic<bool>*>::is_always_lock_free);

void begin_stop() noexcept {
  for (const auto& place : stop_requests) {
    if (std::atomic<bool>* const request = place.load()) request->store(true);
  }
}

void on_stop_signal(int) {
  stop_signals.fetch_add(1);
  begin_stop();
}

/// Returns true if the signal is ignored, as nohup does with SIGHUP so that the terminal may close.
bool is_ignored(int number) noexcept {
  struct sigaction now{};
  return sigaction(number, nullptr, &now) == 0 && now.sa_handler == SIG_IGN;
}

}  // namespace

StopSignal::StopSignal() {
  struct sigaction action{};
  action.sa_handler = on_stop_signal;
  action.sa_flags = SA_RESTART;  // restarts short system calls that a signal can still interrupt
  sigemptyset(&action.sa_mask);
  sigset_t stops;
  sigemptyset(&stops);
  for (const int number : stop_numbers) {
    if (number == SIGHUP && is_ignored(number)) continue;
    sigaction(number, &action, nullptr);
    sigaddset(&stops, number);
  }
  action.sa_handler = request_recording;
  sigaction(SIGUSR1, &action, nullptr);
  sigaddset(&stops, SIGUSR1);
  pthread_sigmask(SIG_BLOCK, &stops, &wait_mask_);
  for (const int number : stop_numbers) sigdelset(&wait_mask_, number);
  sigdelset(&wait_mask_, SIGUSR1);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);  // a write beyond the file size limit then only fails
}

void StopSignal::stop_with(std::atomic<bool>& request) noexcept {
  for (auto& place : stop_requests) {
    std::atomic<bool>* free = nullptr;
    if (place.compare_exchange_strong(free, &request)) break;
  }
  if (count() > 0) begin_stop();
}

void StopSignal::forget_stops() noexcept {
  for (auto& place : stop_requests) place.store(nullptr);
}

void StopSignal::let_through() const noexcept {
  pthread_sigmask(SIG_SETMASK, &wait_mask_, nullptr);
}

bool StopSignal::take_recording_request() noexcept {
  return recording_requested.exchange(false, std::memory_order_relaxed);
}

int StopSignal::count() noexcept { return stop_signals.load(); }

}  // namespace takt
