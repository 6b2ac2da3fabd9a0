#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/takt/live/daemon_client.hpp"
#include "master/core/lss/lss_command.hpp"
#include "master/linux/bus/frame_channel.hpp"

namespace takt {

struct LssAccessOptions {
  LiveOptions live;
  std::string bus;     ///< bus to use directly; empty means through the daemon
  int timeout_ms = 0;  ///< time-out of each answer; 0 means the defaults
};

/// Runs LSS services through the daemon, or directly on a bus of this machine. CiA 305. All
/// functions throw a Failure if the daemon does not answer, or if the bus can't be used.
class LssAccess {
 public:
  explicit LssAccess(const LssAccessOptions& options);

  /// Runs the services one after the other and stops at the first that fails. Returns the results
  /// of the services that ran; the last result gives the reason of a failure.
  std::vector<LssResult> run(std::span<const LssCommand> commands);
  /// Runs one service and returns its result.
  LssResult run(const LssCommand& command) { return run(std::span{&command, 1}).back(); }

 private:
  std::vector<LssResult> ask(std::span<const LssCommand> commands);
  std::vector<LssResult> talk(std::span<const LssCommand> commands);

  LssAccessOptions options_;
  std::optional<DaemonClient> daemon_;
  std::optional<FrameChannel> channel_;
};

}  // namespace takt
