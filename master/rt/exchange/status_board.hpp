#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include "master/core/node_status.hpp"
#include "master/core/pdo_status.hpp"
#include "master/core/stop_state.hpp"
#include "master/rt/exchange/seqlock.hpp"
#include "master/rt/port.hpp"

namespace takt {

/// Source of SYNC, and whether the cycle follows it.
enum class SyncState : std::uint8_t {
  none,     ///< the network has no SYNC
  made,     ///< the master makes SYNC
  awaited,  ///< another device makes SYNC; none has come yet
  locked,   ///< the cycle follows the SYNC of another device
  lost,
};

/// Counters of the bus thread since the start. Trivially copyable, because it crosses threads.
struct BusStatus {
  Time when{};
  std::uint64_t cycle = 0;  ///< number of the newest cycle
  std::uint64_t beats = 0;  ///< SYNCs sent or followed; cycles if there is no SYNC
  /// Periods without SYNC: skipped, or held back while frames could not leave.
  std::uint64_t cycles_missed = 0;
  std::uint64_t cycles_late = 0;      ///< SYNCs that were late by more than a tenth of the period
  std::uint64_t outputs_skipped = 0;  ///< cycles whose outputs could not end before the next SYNC
  std::uint64_t images_incomplete = 0;
  std::uint64_t frames_received = 0;
  std::uint64_t frames_sent = 0;
  std::uint64_t send_failures = 0;  ///< frames that the interface refused
  /// Bits sent and received, with mean stuffing, for the bus load.
  std::uint64_t wire_bits = 0;
  std::uint64_t events_lost = 0;
  SyncState sync = SyncState::none;
  std::uint32_t sync_losses = 0;  ///< losses of a SYNC that another device makes
  Time sync_period{};             ///< measured period of that SYNC
  StopStage stop = StopStage::running;
  StopResult stop_result = StopResult::none;
  PortCondition port;
};
static_assert(std::is_trivially_copyable_v<BusStatus>);

/// The consistent content of status_t. Front side.
struct StatusSnapshot {
  BusStatus bus;
  std::vector<NodeStatus> nodes;  ///< in the order of BusPlan::nodes
  std::vector<PdoStatus> tpdos;   ///< in the order of PdoTable::tpdos
  std::vector<RpdoStatus> rpdos;  ///< in the order of PdoTable::rpdos
};

/// State of the bus for the front thread. The bus thread writes it every few cycles; the front
/// thread may read it at any time.
class StatusBoard {
 public:
  StatusBoard(std::size_t nodes, std::size_t tpdos, std::size_t rpdos = 0);

  /// The bus thread writes the states. `tpdo(row)` returns the status of one TPDO, `rpdo(row)` that
  /// of one RPDO.
  template <class T, class R>
  void write(const BusStatus& bus, std::span<const NodeStatus> nodes, T&& tpdo, R&& rpdo) noexcept {
    lock_.begin();
    lock_.put(0, bus);
    const std::size_t count = nodes.size() < nodes_ ? nodes.size() : nodes_;
    for (std::size_t i = 0; i < count; ++i) lock_.put(node_at(i), nodes[i]);
    for (std::size_t i = 0; i < tpdos_; ++i) lock_.put(tpdo_at(i), tpdo(i));
    for (std::size_t i = 0; i < rpdos_; ++i) lock_.put(rpdo_at(i), rpdo(i));
    lock_.end();
  }

  /// The front thread reads the newest states.
  void read(StatusSnapshot& snapshot) const;
  /// Returns a number that changes with each write(); 0 before the first write(). Front thread.
  std::uint64_t version() const noexcept { return lock_.version(); }

 private:
  static constexpr std::size_t node_at(std::size_t i) noexcept {
    return seqlock_words<BusStatus> + i * seqlock_words<NodeStatus>;
  }
  std::size_t tpdo_at(std::size_t i) const noexcept {
    return node_at(nodes_) + i * seqlock_words<PdoStatus>;
  }
  std::size_t rpdo_at(std::size_t i) const noexcept {
    return tpdo_at(tpdos_) + i * seqlock_words<RpdoStatus>;
  }

  std::size_t nodes_;
  std::size_t tpdos_;
  std::size_t rpdos_;
  Seqlock lock_;
};

}  // namespace takt
