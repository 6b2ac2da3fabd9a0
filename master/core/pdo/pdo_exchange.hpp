#pragma once
#include "master/core/pdo/pdo_inputs.hpp"
#include "master/core/pdo/pdo_outputs.hpp"

namespace takt {

/// The process data of a bus: TPDOs are received into an image, and RPDOs are made from it. Bus
/// thread only; nothing allocates after construction.
class PdoExchange {
 public:
  /// Keeps references to both arguments.
  PdoExchange(const BusPlan& plan, EventQueue& events)
      : image_{plan.layout.signals.size()},
        inputs_{plan, image_, events},
        outputs_{plan, image_, inputs_, events} {}
  PdoExchange(const PdoExchange&) = delete;
  PdoExchange& operator=(const PdoExchange&) = delete;

  PdoInputs& inputs() noexcept { return inputs_; }
  const PdoInputs& inputs() const noexcept { return inputs_; }
  PdoOutputs& outputs() noexcept { return outputs_; }
  const WorkingImage& image() const noexcept { return image_; }

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(image_, inputs_, outputs_);
  }

 private:
  WorkingImage image_;
  PdoInputs inputs_;
  PdoOutputs outputs_;
};

}  // namespace takt
