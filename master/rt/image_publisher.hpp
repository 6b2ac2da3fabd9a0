#pragma once
#include <algorithm>

#include "master/rt/beat/beat.hpp"
#include "master/rt/controller.hpp"
#include "master/rt/exchange/exchange.hpp"
#include "master/rt/machines/bus_machines.hpp"
#include "master/rt/port.hpp"

namespace takt {

/// Gives the image of each cycle to the front thread and to the controller. Bus thread only.
template <Services S>
class ImagePublisher {
 public:
  /// Keeps references to all arguments. `controller` may be null.
  ImagePublisher(Beat& beat, BusMachines<S>& bus, Exchange& exchange,
                 Controller* controller) noexcept
      : beat_{beat}, bus_{bus}, exchange_{exchange}, controller_{controller} {}

  /// Closes the image and publishes it. `condition` is the condition of the port at the end of the
  /// receive window; `predicted` is the time from SYNC to the arrival of the last expected TPDO in
  /// the next cycle.
  void publish(const PortCondition& condition, Time now, Time predicted) noexcept {
    const bool echoed = condition.last_sync_echo >= beat_.sync_at();
    const Time sync_time = echoed ? condition.last_sync_echo : beat_.sync_at();
    if (echoed) exchange_.timing.sync_on_wire.record(sync_time - beat_.deadline());
    beat_.note_publication(now);
    PdoInputs& inputs = bus_.pdos.inputs();
    const std::uint32_t missing = inputs.close(now);
    bus_.status.images_incomplete += missing != 0;
    stamp_ = {.cycle = beat_.cycle(),
              .beat = bus_.status.beats,
              .sync_time = sync_time,
              .publish_time = now,
              .missing = missing};
    const WorkingImage& image = bus_.pdos.image();
    exchange_.images.publish(stamp_, image.values, image.stale, inputs.marks());
    exchange_.timing.sync_to_publish.record(now - sync_time);
    predict(now, predicted);
  }
  /// Tells the front thread when to expect the next image.
  void predict(Time now, Time predicted) noexcept {
    Time next = beat_.next_deadline() + predicted;
    // After a stall within the cycle, the clock will skip the periods that have passed.
    const Time late = now - next;
    if (late > Time{}) next += (late / beat_.period() + 1) * beat_.period();
    exchange_.next_publish.store(next.count(), std::memory_order_release);
  }

  /// Lets the controller compute outputs from the image that was published.
  void run_controller() noexcept {
    if (controller_ == nullptr) return;
    const WorkingImage& image = bus_.pdos.image();
    OutputWriter writer{bus_.pdos.outputs(), {.cycle = stamp_.cycle, .now = stamp_.publish_time}};
    controller_->update({stamp_, image.values, image.stale, bus_.pdos.inputs().marks()}, writer);
  }

 private:
  Beat& beat_;
  BusMachines<S>& bus_;
  Exchange& exchange_;
  Controller* controller_;
  ImageStamp stamp_;  ///< of the newest image
};

}  // namespace takt
