#pragma once
#include <cstdint>
#include <memory>
#include <optional>

#include "eds_parser/table/device_table.hpp"
#include "eds_parser/table/time.hpp"
#include "master/sim/abort.hpp"
#include "master/sim/device_traits.hpp"
#include "master/sim/emcy_producer.hpp"
#include "master/sim/object_store.hpp"
#include "master/sim/random.hpp"

namespace takt::sim {

/// What a device does besides communicating: a drive, inputs and outputs, an encoder. It reads and
/// writes objects of the dictionary; its time is the device's own.
class Model {
 public:
  virtual ~Model() = default;
  /// Power on and reset node: the objects hold their power-on values.
  virtual void reset(Time now) noexcept = 0;
  /// The world goes on up to `now`; inputs are written into the dictionary.
  virtual void advance(Time now) noexcept = 0;
  /// Objects have been written by RPDO or SDO.
  virtual void outputs(Time now) noexcept = 0;
  /// SYNC in OPERATIONAL, after inputs were sampled and outputs taken over.
  virtual void on_sync(Time) noexcept {}
  /// May this value be written by SDO? Called after the checks of the dictionary itself.
  virtual Abort check_write(const Object&, std::uint64_t) const noexcept { return Abort::none; }
  /// May this value be written to a communication object (0x1000..0x1FFF)? Called before the checks
  /// of CiA 301.
  virtual Abort check_communication(const Object&, std::uint64_t) const noexcept {
    return Abort::none;
  }
  /// A communication object has been written by SDO.
  virtual void communication_written(const Object&) noexcept {}
  /// An RPDO of this number (from 1) was taken over; outputs() follows.
  virtual void received(std::uint16_t, Time) noexcept {}
  /// An RPDO of this number has fewer bytes than its mapping. True: the device answers that itself,
  /// without EMCY.
  virtual bool takes_short(std::uint16_t) noexcept { return false; }
  /// SYNC stayed away for longer than 0x1006 lets it.
  virtual void sync_lost(Time) noexcept {}
  /// How the device deviates from CiA 301; constant from construction on.
  virtual DeviceTraits traits() const noexcept { return {}; }
  /// A SYNC that the device itself has sent acts on its own PDOs.
  virtual bool obeys_own_sync() const noexcept { return false; }
  /// Identifier of the SYNC it sends, where that is not 0x1005.
  virtual std::optional<CobId> sync_transmit_id() const noexcept { return {}; }
  /// Heartbeat lost, bus-off or OPERATIONAL left.
  virtual void connection_lost(Time) noexcept {}
  /// A fault: the device reports this error by EMCY and behaves accordingly.
  virtual void fail(std::uint16_t, Time) noexcept {}
  /// When inputs may change next by themselves; `never`: they don't.
  virtual Time next_change() const noexcept { return never; }
};

/// The model of this name (one of sim_models); anything else: a plain device. What a model needs
/// and the dictionary lacks is left out.
std::unique_ptr<Model> make_model(const DeviceTable& table, ObjectStore& store, EmcyProducer& emcy,
                                  Random random);

}  // namespace takt::sim
