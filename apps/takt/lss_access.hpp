#pragma once
#include <expected>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/takt/daemon_client.hpp"
#include "master/core/lss_command.hpp"
#include "master/linux/frame_channel.hpp"

namespace takt {

struct LssAccessOptions {
  LiveOptions live;
  std::string bus;     ///< empty: through the daemon
  int timeout_ms = 0;  ///< of each answer; 0: the defaults
};

/// Where LSS services go: through the daemon, or directly onto a bus of this machine.
class LssAccess {
 public:
  static std::expected<LssAccess, LiveError> open(const LssAccessOptions& options);

  /// Runs the services until one is not done; results of those that were run, the last says why
  /// where not all of them are done.
  std::expected<std::vector<LssResult>, LiveError> run(std::span<const LssCommand> commands);

 private:
  std::expected<std::vector<LssResult>, LiveError> ask(std::span<const LssCommand> commands);
  std::expected<std::vector<LssResult>, LiveError> talk(std::span<const LssCommand> commands);

  LssAccessOptions options_;
  std::optional<DaemonClient> daemon_;
  std::optional<FrameChannel> channel_;
};

}  // namespace takt
