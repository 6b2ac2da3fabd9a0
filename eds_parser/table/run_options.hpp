#pragma once
#include <cstddef>
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

/// `black_box:` of the network file.
struct RecordingOptions {
  std::string folder;            ///< for the recordings; empty: none are made
  std::size_t bytes = 16 << 20;  ///< of each of the two tapes in memory
  std::size_t keep = 20;         ///< recordings of this bus; older ones are removed
};

/// `lcm:` of the network file.
struct LcmOptions {
  std::string url;      ///< empty: LCM_DEFAULT_URL, else LCM's own default
  bool broker = false;  ///< serve tcpq:// on loopback by ourselves
  bool typed = true;    ///< a typed message of each node as well
  std::string keys;     ///< key file: commands are taken in envelopes only; empty: no keys
  bool signs = false;   ///< with keys: all that is published goes out in envelopes as well
};

}  // namespace takt
