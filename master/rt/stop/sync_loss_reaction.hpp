#pragma once
#include <cstdint>

#include "master/core/pdo/fallback_writer.hpp"
#include "master/rt/machines/bus_machines.hpp"
#include "master/rt/stop/axis_stops.hpp"

namespace takt {

/// Reacts to the loss of another device's SYNC as `on_sync_loss` says: sends no outputs, lets the
/// outputs take their fallbacks, or stops the nodes. Bus thread only.
template <Services S>
class SyncLossReaction {
 public:
  /// Keeps references to all arguments.
  SyncLossReaction(BusMachines<S>& bus, AxisStops<S>& stops)
      : bus_{bus}, stops_{stops}, fallbacks_{bus.plan} {}

  /// Begins or ends the reaction. `lost` means that SYNC is lost now.
  void follow(bool lost) noexcept {
    const SyncSupply supply = lost ? SyncSupply::lost : SyncSupply::present;
    if (supply == supply_) return;
    supply_ = supply;
    bus_.status.sync_losses += lost;
    if (bus_.observe || stops_.stopping()) return;
    switch (bus_.plan.cycle.on_sync_loss) {
      case SyncLoss::hold:
        return;  // see withholds_outputs()
      case SyncLoss::fallback:
        return lost ? begin_fallbacks() : end_fallbacks();
      case SyncLoss::stop:
        return lost ? bus_.services.on_sync_loss() : bus_.services.on_sync_back();
    }
  }
  /// Returns true if the loop sends no outputs until SYNC returns.
  bool withholds_outputs() const noexcept {
    return supply_ == SyncSupply::lost && bus_.plan.cycle.on_sync_loss == SyncLoss::hold &&
           !stops_.stopping();
  }

  /// Returns true if fallbacks wait to be written by SDO.
  bool writes_wait() const noexcept { return fallbacks_.waits(); }
  void write_fallbacks(Time now) noexcept {
    for (; fallbacks_.waits(); fallbacks_.submitted()) {
      if (!bus_.exchanging[fallbacks_.node_index()]) continue;
      if (!bus_.services.submit(fallbacks_.request(), now)) return;
      stops_.memories().note(fallbacks_.request());
    }
  }
  /// Drops the fallbacks that are not written yet. They must not reach a drive that is commanded
  /// again or is being stopped.
  void call_off_fallbacks() noexcept {
    fallbacks_.stop();
    bus_.services.withdraw(FallbackWriter::request_id);
  }

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(supply_);
  }

 private:
  enum class SyncSupply : std::uint8_t { present, lost };

  void begin_fallbacks() noexcept {
    bus_.pdos.outputs().fall_back();
    fallbacks_.begin(bus_.pdos.outputs());
  }
  void end_fallbacks() noexcept {
    call_off_fallbacks();
    bus_.pdos.outputs().hear_again();
  }

  BusMachines<S>& bus_;
  AxisStops<S>& stops_;
  FallbackWriter fallbacks_;
  SyncSupply supply_ = SyncSupply::present;
};

}  // namespace takt
