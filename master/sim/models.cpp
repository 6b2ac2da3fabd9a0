#include "master/sim/model.hpp"

namespace takt::sim {
namespace {

/// Only communicates; its objects keep what is written into them.
class PlainModel final : public Model {
 public:
  void reset(Time) noexcept override {}
  void advance(Time) noexcept override {}
  void outputs(Time) noexcept override {}
  void fail(std::uint16_t code, Time) noexcept override { emcy_.tell(code); }

  explicit PlainModel(EmcyProducer& emcy) : emcy_{emcy} {}

 private:
  EmcyProducer& emcy_;
};

}  // namespace

std::unique_ptr<Model> make_model(const DeviceTable&, ObjectStore&, EmcyProducer& emcy, Random) {
  return std::make_unique<PlainModel>(emcy);
}

}  // namespace takt::sim
