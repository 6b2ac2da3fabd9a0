#pragma once
#include <atomic>
#include <csignal>

namespace takt {

/// SIGTERM, SIGINT and SIGHUP as a counter, and SIGUSR1, which asks for a recording. Blocked in all
/// threads from here on, except while one waits with wait_mask(), and in the thread that calls
/// let_through(). A SIGHUP that is ignored already (nohup) stays so.
class StopSignal {
 public:
  StopSignal();

  /// How many have come.
  static int count() noexcept;
  /// SIGUSR1 has come since the last call.
  static bool take_recording_wish() noexcept;
  /// The first stop signal sets `request` from within its handler, so that the ordered stop begins
  /// at once, whatever the front thread is doing; null: no longer. One that has come already sets
  /// it too.
  static void stop_with(std::atomic<bool>* request) noexcept;
  /// From here on the signals interrupt the calling thread wherever it is. Threads that it starts
  /// inherit that.
  void let_through() const noexcept;
  /// The mask for ppoll: stop signals get through.
  const sigset_t* wait_mask() const noexcept { return &wait_mask_; }

 private:
  sigset_t wait_mask_{};
};

}  // namespace takt
