#pragma once
#include <expected>
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

/// Runs LSS services through the daemon, or directly on a bus of this machine. CiA 305.
class LssAccess {
 public:
  static std::expected<LssAccess, LiveError> open(const LssAccessOptions& options);

  /// Runs the services one after the other and stops at the first that fails. Returns the results
  /// of the services that ran; the last result gives the reason of a failure.
  std::expected<std::vector<LssResult>, LiveError> run(std::span<const LssCommand> commands);

 private:
  std::expected<std::vector<LssResult>, LiveError> ask(std::span<const LssCommand> commands);
  std::expected<std::vector<LssResult>, LiveError> talk(std::span<const LssCommand> commands);

  LssAccessOptions options_;
  std::optional<DaemonClient> daemon_;
  std::optional<FrameChannel> channel_;
};

}  // namespace takt
