#pragma once
#include <expected>
#include <functional>
#include <semaphore>
#include <span>
#include <thread>

#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/table/device_table.hpp"
#include "master/master_run.hpp"
#include "master/rt/controller.hpp"
#include "master/sim/bus/sim_port.hpp"
#include "master/sim/bus/world.hpp"

namespace takt {

/// The bus `virtual`: simulated devices in virtual time. The bus thread runs only while the front
/// thread waits in next(). It stops right after each image, where a real cycle waits for the
/// set-points, so that set-points from image k act at SYNC k+1 as on a real bus.
class VirtualTime final : public Controller {
 public:
  VirtualTime(std::span<const DeviceTable> devices, const BusPlan& plan);

  /// Connects `master`, whose controller this object is, to the bus.
  void attach(MasterRun& master);
  /// Starts the bus thread for MasterRun::start(). The thread waits until the first next(). Returns
  /// the errno if no thread can be created.
  std::expected<std::thread, int> start(std::function<void()> body);

  /// Returns the time of the bus. Call this on the front thread, outside next().
  Time now() const noexcept { return world_.now(); }
  /// Runs the bus to its next image. Returns false when the cycles are over.
  bool next() noexcept;
  void update(const ImageView& image, OutputWriter& outputs) noexcept override;

 private:
  sim::World world_;
  sim::SimPort port_;
  std::binary_semaphore image_{0};  // released when the bus thread rests or has ended
  std::binary_semaphore go_{0};     // released when the bus thread may continue
  bool ended_ = false;              // the cycles are over; written before image_ is released
};

}  // namespace takt
