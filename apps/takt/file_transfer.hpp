#pragma once
#include <cstddef>
#include <expected>
#include <functional>
#include <span>
#include <vector>

#include "apps/takt/daemon_client.hpp"
#include "eds_parser/table/ids.hpp"

namespace takt {

/// Bytes that are through, and all of them (0: not known).
using Progress = std::function<void(std::size_t done, std::size_t total)>;

/// A file to or from a domain through the running daemon, in parts. Ctrl-C (Interrupt) aborts it on
/// the bus.
class FileTransfer {
 public:
  struct Target {
    std::int16_t node = 0;
    ObjectKey object;
    int timeout_ms = 0;
  };
  FileTransfer(DaemonClient& daemon, Target target, Progress progress);

  std::expected<void, LiveError> download(std::span<const std::byte> value);
  /// At most `limit` bytes; a device that sends more is ended by an abort.
  std::expected<std::vector<std::byte>, LiveError> upload(std::size_t limit);

 private:
  transfer_t message(const char* action) const;
  void send(transfer_t message);
  // The newest state that comes within a moment; none: silence.
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
