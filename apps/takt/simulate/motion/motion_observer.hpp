#pragma once
#include <span>
#include <string>

#include "apps/takt/simulate/motion/motion_outcome.hpp"
#include "apps/takt/simulate/program/stage.hpp"
#include "apps/takt/simulate/program/virtual_lcm.hpp"
#include "master/rt/exchange/process_image.hpp"

namespace takt {

/// Receives the reports of taktd about the motions of all axes, and keeps the largest values of the
/// entries that are in progress.
class MotionObserver final : public Actor {
 public:
  MotionObserver(VirtualLcm& lcm, const std::string& bus, std::span<MotionOutcome> outcomes);
  Time next() const noexcept override { return lcm_.next_arrival(); }
  void act(Time now) override;
  /// Takes the speeds of the speed axes from an image.
  void see(const ImageView& image);

 private:
  VirtualEndpoint& lcm_;
  std::string channel_;
  std::span<MotionOutcome> outcomes_;
};

}  // namespace takt
