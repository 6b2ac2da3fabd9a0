#pragma once
#include <string>

#include "eds_parser/values/time.hpp"

namespace takt {

/// Sends systemd the messages of a `Type=notify` service (sd_notify(3)). Does nothing without
/// systemd.
class ServiceNotify {
 public:
  ServiceNotify();

  void ready(const std::string& status) const { send("READY=1\nSTATUS=" + status); }
  /// Reports that the ordered stop has begun and may take `limit`, whatever TimeoutStopSec is.
  void stopping(Time limit) const {
    const auto us = std::chrono::duration_cast<std::chrono::microseconds>(limit).count();
    send("STOPPING=1\nEXTEND_TIMEOUT_USEC=" + std::to_string(us));
  }
  /// Resets the watchdog. Call this as often as convenient while the daemon works.
  void alive(Time now);

 private:
  void send(const std::string& text) const;

  std::string socket_;
  Time watchdog_{};  // half of systemd's limit; 0 means no watchdog
  Time last_alive_{};
};

}  // namespace takt
