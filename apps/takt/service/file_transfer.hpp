#pragma once
#include <cstddef>
#include <expected>
#include <functional>
#include <span>
#include <vector>

#include "apps/takt/live/daemon_client.hpp"
#include "eds_parser/table/ids.hpp"

namespace takt {

/// Called with the number of bytes transferred so far and the total; a total of 0 means unknown.
using Progress = std::function<void(std::size_t done, std::size_t total)>;

/// Transfers a file to or from a DOMAIN object through the running daemon, in parts. Ctrl-C
/// (Interrupt) aborts the transfer on the bus.
class FileTransfer {
 public:
  struct Target {
    std::int16_t node = 0;
    ObjectKey object;
    int timeout_ms = 0;
  };
  FileTransfer(DaemonClient& daemon, Target target, Progress progress);

  std::expected<void, LiveError> download(std::span<const std::byte> value);
  /// Reads at most `limit` bytes. If the device sends more, the transfer is aborted.
  std::expected<std::vector<std::byte>, LiveError> upload(std::size_t limit);

 private:
  transfer_t message(const char* action) const;
  void send(transfer_t message);
  // Waits for the daemon's next transfer state. Returns false if none comes before `until`.
  bool hear(Time until);
  std::expected<void, LiveError> begin(const char* action, std::size_t total);
  std::expected<void, LiveError> fill(std::span<const std::byte> value);
  std::expected<void, LiveError> await_end();
  std::expected<std::vector<std::byte>, LiveError> fetch();
  std::expected<void, LiveError> failure() const;
  std::unexpected<LiveError> silent() const;

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
