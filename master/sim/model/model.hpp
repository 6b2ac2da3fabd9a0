#pragma once
#include <cstdint>
#include <memory>
#include <optional>

#include "eds_parser/table/device_table.hpp"
#include "eds_parser/values/time.hpp"
#include "master/sim/dictionary/abort.hpp"
#include "master/sim/dictionary/object_store.hpp"
#include "master/sim/pdo/device_traits.hpp"
#include "master/sim/random.hpp"
#include "master/sim/service/emcy_producer.hpp"

namespace takt::sim {

/// The application of a device besides its communication: a drive, inputs and outputs, or an
/// encoder. A model reads and writes objects of the dictionary. All times are local times of the
/// device. The base has no application: the device only communicates, and its objects keep the
/// values written to them.
class Model {
 public:
  explicit Model(EmcyProducer& emcy) noexcept : emcy_{emcy} {}
  virtual ~Model() = default;
  /// Called at power-on and reset node, when the objects hold their power-on values.
  virtual void reset(Time) noexcept {}
  /// Advances the model to this time and writes its inputs into the dictionary.
  virtual void advance(Time) noexcept {}
  /// Called after an RPDO or SDO has written objects.
  virtual void outputs(Time) noexcept {}
  /// Called at SYNC in OPERATIONAL after the inputs were sampled and the received outputs applied.
  virtual void on_sync(Time) noexcept {}
  /// Checks an SDO write of this value. Called after the checks of the dictionary itself.
  virtual Abort check_write(const Object&, std::uint64_t) const noexcept { return Abort::none; }
  /// Checks an SDO write of this value to a communication object (0x1000..0x1FFF). Called before
  /// the checks of CiA 301.
  virtual Abort check_communication(const Object&, std::uint64_t) const noexcept {
    return Abort::none;
  }
  /// Called after an SDO has written a communication object.
  virtual void communication_written(const Object&) noexcept {}
  /// Called after the RPDO with this number (from 1) was applied; outputs() follows.
  virtual void received(std::uint16_t, Time) noexcept {}
  /// Called if a frame of the RPDO with this number is shorter than its mapping. Returns true if
  /// the model answers the error itself, without an EMCY.
  virtual bool takes_short(std::uint16_t) noexcept { return false; }
  /// Called when SYNC is overdue according to 0x1006.
  virtual void sync_lost(Time) noexcept {}
  /// Returns the deviations from CiA 301; constant after construction.
  virtual DeviceTraits traits() const noexcept { return {}; }
  /// Returns true if a SYNC that the device has sent acts on its own PDOs.
  virtual bool obeys_own_sync() const noexcept { return false; }
  /// Returns the identifier of the SYNC that the device sends, if it differs from 0x1005.
  virtual std::optional<CobId> sync_transmit_id() const noexcept { return {}; }
  /// Called when a heartbeat is lost, at bus-off, and when the device leaves OPERATIONAL.
  virtual void connection_lost(Time) noexcept {}
  /// Injects a fault: the device reports this error by EMCY and behaves accordingly.
  virtual void fail(std::uint16_t code, Time) noexcept {
    emcy_.raise(code, ErrorBit::manufacturer);
  }
  /// Next time at which inputs may change by themselves; `never` if they don't.
  virtual Time next_change() const noexcept { return never; }

 protected:
  EmcyProducer& emcy_;
};

/// Makes the model that the table names (one of sim_models); any other name gives a plain device. A
/// model leaves out functions whose objects the dictionary lacks.
std::unique_ptr<Model> make_model(const DeviceTable& table, ObjectStore& store, EmcyProducer& emcy,
                                  Random random);

}  // namespace takt::sim
