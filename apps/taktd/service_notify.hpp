#pragma once
#include <string>

#include "eds_parser/table/time.hpp"

namespace takt {

/// What systemd wants to hear of a `Type=notify` service (sd_notify(3)). Does nothing where there
/// is no systemd.
class ServiceNotify {
 public:
  ServiceNotify();

  void ready(const std::string& status) const { send("READY=1\nSTATUS=" + status); }
  /// The ordered stop has begun; it may take so long, whatever TimeoutStopSec says.
  void stopping(Time limit) const {
    const auto us = std::chrono::duration_cast<std::chrono::microseconds>(limit).count();
    send("STOPPING=1\nEXTEND_TIMEOUT_USEC=" + std::to_string(us));
  }
  /// Keeps the watchdog quiet; to be called while everything is well, as often as one likes.
  void alive(Time now);

 private:
  void send(const std::string& text) const;

  std::string socket_;
  Time watchdog_{};  // half of systemd's limit; 0: none
  Time last_alive_{};
};

}  // namespace takt
