#pragma once
#include <optional>
#include <string>

#include "master/lcm/rate_limit.hpp"

namespace takt {

/// Keeps a server from polling its listening socket while a new connection can't be accepted,
/// because this process or the machine has no descriptor or no memory left. The connection waits in
/// the kernel and would otherwise wake the server again and again.
class AcceptPause {
 public:
  static constexpr Time length = std::chrono::milliseconds{100};
  static constexpr Time sentence_pause = std::chrono::seconds{10};

  /// Takes the errno of an accept() that failed. Begins a pause if resources are missing. Returns
  /// the reason, for people, at most once in `sentence_pause`.
  std::optional<std::string> failed(int error, Time now);
  /// Returns true while the listening socket must be left alone.
  bool active(Time now) const noexcept { return now < until_; }

 private:
  Time until_{};
  RateLimit reported_{sentence_pause};
};

}  // namespace takt
