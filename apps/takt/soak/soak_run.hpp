#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "apps/takt/soak/evidence/verdict.hpp"
#include "apps/takt/soak/front_defect.hpp"
#include "eds_parser/network_file/load_network.hpp"

namespace takt {
struct Exchange;
}
namespace takt::sim {
class World;
}

namespace takt::soak {

/// In which runs of the front thread the programs also command motions.
enum class MotionRuns : std::uint8_t {
  some,  ///< runs whose seed leaves the remainder 4 when it is divided by 5
  all,
};

struct SoakOptions {
  std::uint64_t seed = 1;
  /// Duration of the faults; afterwards all nodes must recover.
  Time duration = std::chrono::seconds{20};
  std::string candump{};  ///< file for all frames; empty means no file
  MotionRuns motions = MotionRuns::some;
  bool verbose = false;  ///< prints faults and events to stderr
  /// A hook that is called after each cycle, before the judges check the cycle. The judges must
  /// find the defects that the hook causes.
  std::function<void(Exchange&, sim::World&)> defect{};
  FrontDefect front{};
};

/// Counters of one run, or of several runs.
struct SoakCounts {
  Time simulated{};
  std::uint64_t images = 0;
  std::uint64_t frames = 0;
  std::uint64_t random_frames = 0;  ///< frames that the intruder sent
  std::uint64_t faults = 0;
  std::uint64_t requests = 0;
  std::uint64_t boots = 0;  ///< successful boots
  std::uint64_t events = 0;
  std::uint64_t commands = 0;  ///< commands that the programs sent
  std::uint64_t moves = 0;     ///< positions on the wire that the programs commanded
  std::uint64_t motions = 0;   ///< motions of an axis that the programs commanded
  std::uint64_t arrivals = 0;  ///< motions that ended at their target
  std::uint64_t groups = 0;    ///< groups whose begin was seen and judged
  std::uint64_t gears = 0;     ///< gears that the programs commanded
  std::uint64_t streams = 0;   ///< streams that the programs began
  /// Streams that were compared with their paths up to their ends.
  std::uint64_t judged_streams = 0;
  std::uint64_t judged_gears = 0;    ///< locked gears that were compared with their leaders
  std::uint64_t homings = 0;         ///< homing runs of programs that have ended well
  std::uint64_t forged = 0;          ///< forged messages
  std::uint64_t program_faults = 0;  ///< faults of programs: stalls, deaths, rivals, replays ...

  SoakCounts& operator+=(const SoakCounts& other) noexcept;
};

/// One run and its first violation.
struct SoakOutcome : SoakCounts {
  std::uint64_t seed = 0;
  std::optional<Violation> violation{};
};

/// Runs the bus thread and a whole network in virtual time with a random sequence of faults. The
/// same seed gives the same run.
SoakOutcome soak(const LoadedNetwork& network, const SoakOptions& options);

}  // namespace takt::soak
