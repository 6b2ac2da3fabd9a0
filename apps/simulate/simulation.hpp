#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "apps/simulate/program_faults.hpp"
#include "apps/simulate/wire_statistics.hpp"
#include "eds_parser/network_file/load_network.hpp"
#include "master/core/event.hpp"
#include "master/gateway/commands.hpp"
#include "master/rt/status_board.hpp"
#include "master/sim/faults.hpp"
#include "master/sim/virtual_bus.hpp"

namespace takt {

struct SimulationOptions {
  Time duration = std::chrono::seconds{10};
  std::uint64_t seed = 1;
  sim::Faults faults{};
  bool move = false;  ///< built-in sine set-points, see SineMotion
  /// So many programs command the axes over LCM, through the whole taktd; 0: the bus thread is
  /// alone. At most most_applications, without `move`.
  std::size_t applications = 0;
  ProgramFaults programs{};  ///< what happens to them and to taktd
  Time wake_jitter{};        ///< of the simulated master's machine
  Time after{};              ///< without master, at the end
  std::string candump{};     ///< file for all frames as a candump log; empty: none
};

/// Each program is known by the low bits of its positions; see VirtualApplication.
inline constexpr std::size_t most_applications = 6;

/// Event as the simulation tells it.
struct ToldEvent {
  Time when{};
  EventKind kind = EventKind::node_state;
  std::uint8_t node = 0;
  std::string text;
};

struct NodeOutcome {
  std::string name{};
  std::uint8_t id = 0;
  NodeStatus status{};
  std::optional<Time> first_boot{};  ///< when its first boot was done
  std::uint32_t boot_failures = 0;
  std::uint64_t tpdo_frames = 0;
  std::uint64_t tpdo_missing = 0;  ///< times it was expected and stayed away
  std::uint64_t tpdo_late = 0;
  std::uint64_t rpdo_frames = 0;
  Time worst_tpdo{};  ///< SYNC to the end of its last TPDO, until the stop
};

/// A program that commands axes over LCM.
struct ApplicationOutcome {
  std::string name;
  std::uint64_t images = 0;    ///< that it has used
  std::uint64_t commands = 0;  ///< that it has sent
  std::uint64_t lost = 0;      ///< messages that found its queue full
};

/// What the front thread of taktd did, and the programs beside it.
struct FrontOutcome {
  std::uint64_t starts = 0;  ///< of taktd
  std::uint64_t images = 0;  ///< published
  std::uint64_t commands_taken = 0;
  std::array<std::uint64_t, command_refusals> refused{};  ///< in the order of CommandRefusal
  std::uint64_t damaged = 0;                              ///< messages that could not be read
  std::uint64_t gaps = 0;       ///< times that it stood still, so that what waited was discarded
  std::uint64_t lost = 0;       ///< messages that found its queue full
  std::uint64_t fallbacks = 0;  ///< outputs whose command outlived its time to live
  std::vector<ApplicationOutcome> applications{};
};

/// What became of a simulated run. Nothing in it depends on the wall clock.
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
  std::uint64_t emcy_after = 0;  ///< of these when the master had ended
  std::vector<NodeOutcome> nodes;
  std::vector<ToldEvent> events;  ///< the first ones
  std::uint64_t events_total = 0;
  std::size_t axes_moved = 0;
  bool move = false;
  std::optional<FrontOutcome> front;  ///< where there are applications
  bool stopped = false;               ///< the ordered stop came to its end
  StopResult stop = StopResult::none;
  std::vector<std::string> unconfirmed;  ///< a sentence for each axis that was not stopped
  bool mandatory_failed = false;         ///< a mandatory node never booted
};

/// The whole master and its devices in virtual time. Throws std::runtime_error where the candump
/// file can't be written.
SimulationOutcome simulate(const LoadedNetwork& network, const SimulationOptions& options);

}  // namespace takt
