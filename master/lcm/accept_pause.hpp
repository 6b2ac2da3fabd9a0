#pragma once
#include <expected>
#include <string>

#include "master/lcm/rate_limit.hpp"
#include "master/linux/file_descriptor.hpp"

namespace takt {

/// Keeps a server from polling its listening socket while a new connection can't be accepted,
/// because this process or the machine has no descriptor or no memory left. The connection waits in
/// the kernel and would otherwise wake the server again and again.
class AcceptPause {
 public:
  static constexpr Time length = std::chrono::milliseconds{100};
  static constexpr Time sentence_pause = std::chrono::seconds{10};

  /// Accepts a connection. Begins a pause if resources are missing. The error is a text for the
  /// user with the reason, at most once in `sentence_pause`. The text is empty if there is nothing
  /// to report.
  std::expected<FileDescriptor, std::string> accept(int listener, Time now);
  /// Returns true while the listening socket must not be polled.
  bool active(Time now) const noexcept { return now < until_; }

 private:
  Time until_{};
  RateLimit reported_{sentence_pause};
};

}  // namespace takt
