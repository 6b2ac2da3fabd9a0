#pragma once
#include <csignal>

namespace takt {

/// SIGTERM, SIGINT and SIGHUP as a counter, and SIGUSR1, which asks for a recording. Blocked in all
/// threads from here on, except while the front thread waits with wait_mask(), so none is ever lost
/// between a look and a wait. A SIGHUP that is ignored already (nohup) stays so.
class StopSignal {
 public:
  StopSignal();

  /// How many have come.
  static int count() noexcept;
  /// SIGUSR1 has come since the last call.
  static bool take_recording_wish() noexcept;
  /// The mask for ppoll: stop signals get through.
  const sigset_t* wait_mask() const noexcept { return &wait_mask_; }

 private:
  sigset_t wait_mask_{};
};

}  // namespace takt
