#pragma once

#include "master/sim/family/drv28_parameters.hpp"
#include "master/sim/family/ramp.hpp"
#include "master/sim/model/model.hpp"

namespace takt::sim {

/// An Astraada DRV-28 inverter with its CANopen card. PDO1 reads and writes parameters of the
/// inverter. TPDO types: 1..240; 254 on change, at most once in the disabled time (ms, at least
/// 50); 255 in answer to the RPDO of the same number. With an event timer, only the timer sends
/// types 254 and 255.
class AstraadaDrv28 final : public Model {
 public:
  AstraadaDrv28(ObjectStore& store, EmcyProducer& emcy);

  void reset(Time now) noexcept override;
  void advance(Time now) noexcept override;
  void outputs(Time now) noexcept override;
  void received(std::uint16_t rpdo, Time now) noexcept override;
  bool takes_short(std::uint16_t rpdo) noexcept override;
  Abort check_communication(const Object& object, std::uint64_t raw) const noexcept override;
  void connection_lost(Time now) noexcept override;
  void fail(std::uint16_t code, Time now) noexcept override;
  Time next_change() const noexcept override { return frequency_.next_change(); }
  DeviceTraits traits() const noexcept override;

 private:
  /// The objects for request and response of PDO1, and for commands and states of the inverter.
  struct Slots {
    Object* request_code;
    Object* request_address;
    Object* request_data;
    Object* response_code;
    Object* response_error;
    Object* response_data;
    Object* control;
    Object* set_point;
    Object* status;
    Object* frequency;
  };

  bool complete() const noexcept;
  bool running() const noexcept { return frequency_.value() != 0; }
  void serve_request() noexcept;
  void respond(std::uint16_t code, Drv28Parameters::Answer answer) noexcept;
  void command() noexcept;
  void publish() noexcept;

  ObjectStore& store_;
  Slots slots_;
  Drv28Parameters parameters_;
  Ramp frequency_;  ///< output frequency in 0.01 Hz
  bool fault_ = false;
};

}  // namespace takt::sim
