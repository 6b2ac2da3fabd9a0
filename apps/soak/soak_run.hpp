#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "apps/soak/front_meddle.hpp"
#include "apps/soak/verdict.hpp"
#include "eds_parser/network_file/load_network.hpp"

namespace takt {

struct Exchange;
namespace sim {
class World;
}

struct SoakOptions {
  std::uint64_t seed = 1;
  Time duration = std::chrono::seconds{20};  ///< of the walk; then all must come back
  std::string candump{};                     ///< file for all frames; empty: none
  bool verbose = false;                      ///< faults and events to stderr
  /// Called after each cycle, before the judges look: what it breaks, they have to tell.
  std::function<void(Exchange&, sim::World&)> meddle{};
  FrontMeddle front{};
};

/// What one run did, and what it did wrong.
struct SoakOutcome {
  std::uint64_t seed = 0;
  Time simulated{};
  std::uint64_t images = 0;
  std::uint64_t frames = 0;
  std::uint64_t rubbish = 0;  ///< frames of the intruder
  std::uint64_t faults = 0;
  std::uint64_t requests = 0;
  std::uint64_t boots = 0;  ///< that ended well
  std::uint64_t events = 0;
  std::uint64_t commands = 0;  ///< that programs have sent
  std::uint64_t moves = 0;     ///< positions of theirs on the wire
  std::uint64_t forged = 0;    ///< messages
  std::uint64_t troubles = 0;  ///< of programs: stalls, deaths, rivals, replays ...
  std::optional<Violation> violation{};
};

/// One random walk of faults through a whole network in virtual time. The same seed gives the same
/// run.
SoakOutcome soak(const LoadedNetwork& network, const SoakOptions& options);

}  // namespace takt
