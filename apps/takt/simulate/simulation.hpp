#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "apps/takt/simulate/motion/motion_outcome.hpp"
#include "apps/takt/simulate/program/program_faults.hpp"
#include "apps/takt/simulate/wire_statistics.hpp"
#include "eds_parser/network_file/load_network.hpp"
#include "master/core/event.hpp"
#include "master/gateway/command/commands.hpp"
#include "master/rt/exchange/status_board.hpp"
#include "master/sim/bus/faults.hpp"
#include "master/sim/bus/virtual_bus.hpp"

namespace takt {

struct SimulationOptions {
  Time duration = std::chrono::seconds{10};
  std::uint64_t seed = 1;
  sim::Faults faults{};
  bool move = false;  ///< built-in sine set-points, see SineMotion
  /// Number of programs (0 .. most_applications) that command the axes over LCM. With programs or
  /// `motions`, all of taktd is simulated, otherwise only the bus thread. Excludes `move`.
  std::size_t applications = 0;
  ProgramFaults programs{};  ///< faults of the programs and of taktd
  /// Programs that command motions over LCM, through the whole taktd. Applications leave the nodes
  /// of their axes alone. Excludes `move`.
  MotionScripts motions{};
  Time wake_jitter{};     ///< longest wake-up delay of the simulated bus thread
  Time after{};           ///< how long the devices run on after the master has ended
  std::string candump{};  ///< file for all frames as a candump log; empty means no file
};

/// Greatest number of programs. The low bits of a position identify the program that commanded it;
/// see VirtualApplication.
inline constexpr std::size_t most_applications = 6;

/// An event as the simulation reports it.
struct ReportedEvent {
  Time when{};
  EventKind kind = EventKind::node_state;
  std::uint8_t node = 0;
  std::string text;
};

struct NodeOutcome {
  std::string name{};
  std::uint8_t id = 0;
  NodeStatus status{};
  std::optional<Time> first_boot{};  ///< end of the first successful boot
  std::uint32_t boot_failures = 0;
  std::uint64_t tpdo_frames = 0;
  std::uint64_t tpdo_missing = 0;  ///< expected TPDOs that did not arrive
  std::uint64_t tpdo_late = 0;
  std::uint64_t rpdo_frames = 0;
  Time worst_tpdo{};  ///< longest time from SYNC to the end of a TPDO, before the stop
};

/// Counters of a program that commands axes over LCM.
struct ApplicationOutcome {
  std::string name;
  std::uint64_t images = 0;    ///< images used
  std::uint64_t commands = 0;  ///< commands sent
  std::uint64_t lost = 0;      ///< messages lost because the program's queue was full
};

/// Counters of the front thread of taktd and of the programs beside it.
struct FrontOutcome {
  std::uint64_t starts = 0;  ///< starts of taktd
  std::uint64_t images = 0;  ///< images published
  std::uint64_t commands_taken = 0;
  std::array<std::uint64_t, command_refusals> refused{};  ///< counts in the order of CommandRefusal
  std::uint64_t damaged = 0;                              ///< messages that could not be decoded
  std::uint64_t gaps = 0;       ///< stalls of the front thread that discarded waiting requests
  std::uint64_t lost = 0;       ///< messages lost because the queue of taktd was full
  std::uint64_t fallbacks = 0;  ///< fallbacks of outputs whose command had expired
  std::vector<ApplicationOutcome> applications{};
};

/// The outcome of a simulated run. It does not depend on the wall clock.
struct SimulationOutcome {
  std::string bus;
  std::uint64_t seed = 0;
  Time simulated{};
  Time period{};
  std::uint32_t bitrate = 0;
  BusStatus loop;
  sim::BusCounters wire;
  SyncOnWire sync;
  std::uint64_t worst_cycle_bits = 0;
  std::uint64_t sdo_frames = 0;
  std::uint64_t emcy_frames = 0;
  std::uint64_t emcy_after = 0;  ///< part of emcy_frames that came after the end of the master
  std::vector<NodeOutcome> nodes;
  std::vector<ReportedEvent> events;  ///< the first 500 events
  std::uint64_t events_total = 0;
  std::size_t axes_moved = 0;
  bool move = false;
  std::optional<FrontOutcome> front;   ///< empty without applications and motions
  std::size_t programs = 0;            ///< number of programs that command motions
  std::vector<MotionOutcome> motions;  ///< results in the order of the file
  bool stopped = false;                ///< the ordered stop was completed in time
  StopResult stop = StopResult::none;
  std::vector<std::string> unconfirmed;  ///< a sentence for each axis that was not stopped
  bool mandatory_failed = false;         ///< a mandatory node never booted
};

/// Returns the exit code of `takt simulate`: 6 if the stop was not confirmed, 4 if a mandatory node
/// never booted, 1 if a motion ended otherwise than expected, or 0.
int exit_code_of(const SimulationOutcome& outcome);

/// Runs the whole master and its devices in virtual time. Throws std::runtime_error if the candump
/// file cannot be written.
SimulationOutcome simulate(const LoadedNetwork& network, const SimulationOptions& options);

}  // namespace takt
