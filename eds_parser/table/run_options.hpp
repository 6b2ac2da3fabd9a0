#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "eds_parser/table/time.hpp"

namespace takt {

/// What happens where the machine does not grant real time.
enum class RtMode : std::uint8_t {
  enforce,  ///< refuse to start
  attempt,  ///< `try`: say what is missing and go on
  off,      ///< do not ask
};

/// `realtime:` of the network file.
struct RealtimeOptions {
  RtMode mode = RtMode::attempt;
  int priority = 80;                           ///< SCHED_FIFO, 1..99
  std::optional<int> cpu;                      ///< none: any
  Time spin = std::chrono::microseconds{100};  ///< awake so long before SYNC
  Time late_limit{};  ///< enforce: a SYNC later than this ends taktd with exit code 5; 0 = none
};

/// `lcm:` of the network file.
struct LcmOptions {
  std::string url;      ///< empty: LCM_DEFAULT_URL, else LCM's own default
  bool broker = false;  ///< serve tcpq:// on loopback by ourselves
};

}  // namespace takt
