#pragma once
#include "eds_parser/table/device_table.hpp"
#include "eds_parser/table/firmware.hpp"
#include "master/sim/family/ramp.hpp"
#include "master/sim/model/model.hpp"

namespace takt::sim {

/// A Lenze 8400 HighLine on its system bus. The transmission types 254 and 255 mean the same. The
/// cycle time causes transmissions in addition to those by events. A TPDO of type 0 is sent at a
/// SYNC after an event. From firmware 16.00.00 on, a SYNC producer reacts to its own SYNC as to a
/// received one, if it sends and receives SYNC with the same identifier. Word 1 is the control or
/// status word (device control), and word 2 is a speed. The ramp from standstill to the reference
/// speed takes one second. A rising edge of bit 7 resets a fault.
class Lenze8400 final : public Model {
 public:
  Lenze8400(const DeviceTable& table, ObjectStore& store, EmcyProducer& emcy);

  void reset(Time now) noexcept override;
  void advance(Time now) noexcept override;
  void outputs(Time now) noexcept override;
  Abort check_communication(const Object& object, std::uint64_t raw) const noexcept override;
  void communication_written(const Object& object) noexcept override;
  void connection_lost(Time now) noexcept override;
  void fail(std::uint16_t code, Time now) noexcept override;
  Time next_change() const noexcept override { return speed_.next_change(); }
  DeviceTraits traits() const noexcept override;
  bool obeys_own_sync() const noexcept override;
  std::optional<CobId> sync_transmit_id() const noexcept override;

 private:
  std::uint64_t order() const noexcept;
  bool enabled() const noexcept;
  void publish() noexcept;

  ObjectStore& store_;
  Firmware firmware_;
  Object* control_;
  Object* set_point_;
  Object* status_;
  Object* actual_;
  Object* sync_in_;   ///< code C00367
  Object* sync_out_;  ///< code C00368
  Ramp speed_;
  bool fault_ = false;
  bool resets_ = false;  ///< the control word has the bit that resets a fault
};

}  // namespace takt::sim
