#pragma once
#include <memory>
#include <vector>

#include "master/sim/model/axis402.hpp"
#include "master/sim/model/model.hpp"

namespace takt::sim {

/// A drive with one to eight axes. Axis n exists if the dictionary has a controlword 0x800 x n
/// above 0x6040. CiA 402-2.
class Drive402 final : public Model {
 public:
  /// Without `mechanics` (nullptr), the motors are simple lags.
  Drive402(ObjectStore& store, EmcyProducer& emcy, Random random,
           const MechanicsTable* mechanics = nullptr);

  void reset(Time now) noexcept override;
  void advance(Time now) noexcept override;
  void outputs(Time now) noexcept override;
  void on_sync(Time now) noexcept override;
  Abort check_write(const Object& object, std::uint64_t raw) const noexcept override;
  void connection_lost(Time now) noexcept override;
  void fail(std::uint16_t code, Time now) noexcept override;
  Time next_change() const noexcept override;

 private:
  std::vector<std::unique_ptr<Axis402>> axes_;
};

}  // namespace takt::sim
