#pragma once
#include <atomic>
#include <csignal>
#include <cstddef>

namespace takt {

/// Counts SIGTERM, SIGINT and SIGHUP, and notes SIGUSR1, which asks for a recording. The
/// constructor blocks these signals in the calling thread and in all threads that it starts later.
/// They arrive only while a thread waits with wait_mask() and in the thread that calls
/// let_through(). If SIGHUP is already ignored (nohup), it stays ignored.
class StopSignal {
 public:
  StopSignal();

  /// Returns the number of stop signals that have arrived so far.
  static int count() noexcept;
  /// Returns true if SIGUSR1 has arrived since the last call.
  static bool take_recording_request() noexcept;
  /// Largest number of flags that one process can give to stop_with().
  static constexpr std::size_t most_requests = 16;
  /// From this call on, a stop signal also sets `request` from within its handler, so that the
  /// ordered stop begins at once, whatever the front thread is doing. If a stop signal has already
  /// arrived, the call itself sets `request`.
  static void stop_with(std::atomic<bool>& request) noexcept;
  /// Ends stop_with() for all flags. Call this before the first flag is destroyed.
  static void forget_stops() noexcept;
  /// From this call on, the signals interrupt the calling thread at any point. Threads that it
  /// starts inherit the mask.
  void let_through() const noexcept;
  /// Returns the signal mask for ppoll, which lets the signals of this class through.
  const sigset_t* wait_mask() const noexcept { return &wait_mask_; }

 private:
  sigset_t wait_mask_{};
};

}  // namespace takt
