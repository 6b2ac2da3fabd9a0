#include <algorithm>

#include "master/sim/family/astraada_drv28.hpp"
#include "master/sim/family/beckhoff_io.hpp"
#include "master/sim/family/lenze8400.hpp"
#include "master/sim/family/plain301.hpp"
#include "master/sim/model/drive402.hpp"
#include "master/sim/model/encoder406.hpp"
#include "master/sim/model/io401.hpp"
#include "master/sim/model/model.hpp"

namespace takt::sim {
namespace {

bool has_quirk(const DeviceTable& table, std::string_view quirk) {
  return std::ranges::find(table.quirks, quirk) != table.quirks.end();
}

}  // namespace

std::unique_ptr<Model> make_model(const DeviceTable& table, ObjectStore& store, EmcyProducer& emcy,
                                  Random random) {
  if (table.model == "drive402") {
    const MechanicsTable* const mechanics = table.mechanics ? &*table.mechanics : nullptr;
    return std::make_unique<Drive402>(store, emcy, random, mechanics);
  }
  if (table.model == "encoder406") return std::make_unique<Encoder406>(store, emcy, random);
  const bool loopback = has_quirk(table, "loopback");
  if (table.model == "io401") return std::make_unique<Io401>(store, emcy, random, loopback);
  if (table.model == "beckhoff") return std::make_unique<BeckhoffIo>(store, emcy, random, loopback);
  if (table.model == "lenze8400") return std::make_unique<Lenze8400>(table, store, emcy);
  if (table.model == "astraada_drv28") return std::make_unique<AstraadaDrv28>(store, emcy);
  if (table.model == "plain301") {
    const auto reading = has_quirk(table, "event_timer_raster") ? EventTimerReading::own_raster
                                                                : EventTimerReading::restarts;
    return std::make_unique<Plain301>(store, emcy, reading);
  }
  return std::make_unique<Model>(emcy);
}

}  // namespace takt::sim
