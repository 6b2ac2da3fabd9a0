#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "apps/simulate/wire_statistics.hpp"
#include "eds_parser/network_file/load_network.hpp"
#include "master/core/event.hpp"
#include "master/rt/status_board.hpp"
#include "master/sim/faults.hpp"
#include "master/sim/virtual_bus.hpp"

namespace takt {

struct SimulationOptions {
  Time duration = std::chrono::seconds{10};
  std::uint64_t seed = 1;
  sim::Faults faults{};
  bool move = false;      ///< built-in sine set-points, see SineMotion
  Time wake_jitter{};     ///< of the simulated master's machine
  Time after{};           ///< without master, at the end
  std::string candump{};  ///< file for all frames as a candump log; empty: none
};

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
  bool stopped = false;  ///< the ordered stop came to its end
  StopResult stop = StopResult::none;
  std::vector<std::string> unconfirmed;  ///< a sentence for each axis that was not stopped
  bool mandatory_failed = false;         ///< a mandatory node never booted
};

/// The whole master and its devices in virtual time. Throws std::runtime_error where the candump
/// file can't be written.
SimulationOutcome simulate(const LoadedNetwork& network, const SimulationOptions& options);

}  // namespace takt
