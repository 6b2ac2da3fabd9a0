#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "eds_parser/values/time.hpp"

namespace takt {

/// What taktd does if the machine does not grant real-time scheduling.
enum class RtMode : std::uint8_t {
  enforce,  ///< refuse to start
  attempt,  ///< `try`: report what is missing and go on
  off,      ///< do not request real-time scheduling
};

/// `realtime:` of the network file.
struct RealtimeOptions {
  RtMode mode = RtMode::attempt;
  int priority = 80;                           ///< SCHED_FIFO, 1..99
  std::optional<int> cpu;                      ///< CPU of the bus thread; empty = any
  Time spin = std::chrono::microseconds{100};  ///< duration of active waiting before SYNC
  Time late_limit{};  ///< enforce: a SYNC later than this ends taktd with exit code 5; 0 = no limit
};

/// `black_box:` of the network file.
struct RecordingOptions {
  std::string folder;            ///< folder of the recordings; empty = no recordings
  std::size_t bytes = 16 << 20;  ///< size of each of the two recording buffers in memory
  std::size_t keep = 20;         ///< number of recordings of this bus; older ones are removed
};

/// `lcm:` of the network file.
struct LcmOptions {
  std::string url;      ///< empty = LCM_DEFAULT_URL if set, else LCM's default
  bool broker = false;  ///< taktd itself serves tcpq:// on loopback
  bool typed = true;    ///< also publish a typed message for each node
  std::string keys;     ///< key file: only commands in envelopes are accepted; empty = no keys
  bool signs = false;   ///< with keys: taktd publishes all messages in envelopes too
};

}  // namespace takt
