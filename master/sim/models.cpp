#include <algorithm>

#include "master/sim/drive402.hpp"
#include "master/sim/encoder406.hpp"
#include "master/sim/io401.hpp"
#include "master/sim/model.hpp"

namespace takt::sim {
namespace {

/// Only communicates; its objects keep what is written into them.
class PlainModel final : public Model {
 public:
  explicit PlainModel(EmcyProducer& emcy) : emcy_{emcy} {}

  void reset(Time) noexcept override {}
  void advance(Time) noexcept override {}
  void outputs(Time) noexcept override {}
  void fail(std::uint16_t code, Time) noexcept override {
    emcy_.raise(code, ErrorBit::manufacturer);
  }

 private:
  EmcyProducer& emcy_;
};

}  // namespace

std::unique_ptr<Model> make_model(const DeviceTable& table, ObjectStore& store, EmcyProducer& emcy,
                                  Random random) {
  if (table.model == "drive402") return std::make_unique<Drive402>(store, emcy, random);
  if (table.model == "encoder406") return std::make_unique<Encoder406>(store, emcy, random);
  if (table.model == "io401") {
    const bool loopback = std::ranges::find(table.quirks, "loopback") != table.quirks.end();
    return std::make_unique<Io401>(store, emcy, random, loopback);
  }
  return std::make_unique<PlainModel>(emcy);
}

}  // namespace takt::sim
