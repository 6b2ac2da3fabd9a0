#pragma once
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "apps/takt/live/daemon_client.hpp"
#include "eds_parser/values/ids.hpp"

namespace takt {

/// Called with the number of bytes transferred so far and the total; a total of 0 means unknown.
using Progress = std::function<void(std::size_t done, std::size_t total)>;

/// Transfers a file to or from a DOMAIN object through the running daemon, in parts. Ctrl-C
/// (Interrupt) aborts the transfer on the bus. A transfer that fails throws a Failure.
class FileTransfer {
 public:
  struct Target {
    std::int16_t node = 0;
    ObjectKey object;
    int timeout_ms = 0;
  };
  FileTransfer(DaemonClient& daemon, Target target, Progress progress);

  void download(std::span<const std::byte> value);
  /// Reads at most `limit` bytes. If the device sends more, the transfer is aborted.
  std::vector<std::byte> upload(std::size_t limit);

 private:
  transfer_t message(const char* action) const;
  void send(transfer_t message);
  // Waits for the daemon's next transfer state. Returns false if none comes before `until`.
  bool hear(Time until);
  void begin(const char* action, std::size_t total);
  void fill(std::span<const std::byte> value);
  void await_end();
  void fetch();
  void check() const;

  DaemonClient& daemon_;
  Target target_;
  Progress progress_;
  std::int64_t id_;
  std::string sender_;
  std::vector<std::byte> buffer_;
  transfer_state_t state_{};
  std::vector<std::byte> value_;
  bool aborted_ = false;
};

}  // namespace takt
