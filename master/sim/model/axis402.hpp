#pragma once
#include <cstdint>
#include <memory>

#include "eds_parser/table/mechanics.hpp"
#include "eds_parser/values/time.hpp"
#include "master/sim/axis/axis_objects.hpp"
#include "master/sim/axis/axis_servo.hpp"
#include "master/sim/axis/cyclic_position.hpp"
#include "master/sim/axis/homing.hpp"
#include "master/sim/axis/motion.hpp"
#include "master/sim/axis/point_buffer.hpp"
#include "master/sim/axis/profile_position.hpp"
#include "master/sim/dictionary/abort.hpp"
#include "master/sim/model/drive_state.hpp"
#include "master/sim/random.hpp"
#include "master/sim/service/emcy_producer.hpp"

namespace takt::sim {

/// Modes of operation that an axis can support. CiA 402-2, 0x6060.
enum class DriveMode : std::int8_t {
  none = 0,
  profile_position = 1,
  profile_velocity = 3,
  profile_torque = 4,
  homing = 6,
  interpolated_position = 7,
  cyclic_position = 8,
  cyclic_velocity = 9,
  cyclic_torque = 10,
};

/// One axis of a drive: state machine, modes, motor. The motor is a simple lag, or a servo with its
/// mechanics.
class Axis402 {
 public:
  /// `number` counts from 0. Without `mechanics` (nullptr), the motor is a simple lag.
  Axis402(ObjectStore& store, EmcyProducer& emcy, Random random, std::uint8_t number,
          const MechanicsTable* mechanics = nullptr);
  Axis402(const Axis402&) = delete;
  Axis402& operator=(const Axis402&) = delete;

  void reset(Time now) noexcept;
  void advance(Time now) noexcept;
  void outputs(Time now) noexcept;
  void on_sync(Time now) noexcept;
  Abort check_write(const Object& object, std::uint64_t raw) const noexcept;
  void connection_lost() noexcept;
  void fail(std::uint16_t code) noexcept;
  Time next_change() const noexcept { return idle() ? never : time_ + Time{1}; }

  DriveState state() const noexcept { return state_; }

 private:
  bool idle() const noexcept;
  bool waits_for_brake(DriveState next) const noexcept;
  void meet_motion() noexcept;
  /// The first manufacturer byte of an EMCY is the number of the axis, counted from 1.
  EmcyProducer::Detail axis_detail() const noexcept {
    return {static_cast<std::uint8_t>(number_ + 1)};
  }
  bool knows(std::int64_t mode) const noexcept;
  void follow_controlword() noexcept;
  void go(DriveState next) noexcept;
  void enter(DriveState next) noexcept;
  void reset_fault() noexcept;
  void follow_mode() noexcept;
  void start_mode() noexcept;
  void take_cyclic_target(double period) noexcept;
  double interpolation_period() const noexcept;

  void step(Time span) noexcept;
  void step_enabled(double h) noexcept;
  void step_mode(double h) noexcept;
  bool blocks(double h) noexcept;
  void step_points(double h) noexcept;
  bool next_point() noexcept;
  double stop_ramp() const noexcept;
  double reported_period() const noexcept;
  double wanted_direction() const noexcept;
  void step_torque(double h) noexcept;
  void step_stopping(double h) noexcept;
  void step_unpowered(double h) noexcept;
  void follow_position(double h) noexcept;
  void follow_velocity(double target, double limit, double h) noexcept;
  void read_servo() noexcept;
  bool stands() const noexcept;
  double strongest() const noexcept;
  void stop_has_ended() noexcept;
  void supervise_following_error(Time span) noexcept;
  void supervise_target(Time span) noexcept;
  Ramps ramps() const noexcept;
  double stop_deceleration() const noexcept;
  bool halted() const noexcept;
  bool controls_position() const noexcept;

  void publish() noexcept;
  void publish_state() noexcept;
  void publish_motion() noexcept;
  void publish_torque() noexcept;
  std::uint16_t statusword() const noexcept;
  std::uint16_t mode_bits() const noexcept;

  AxisObjects objects_;
  EmcyProducer& emcy_;
  std::uint8_t number_;
  ProfilePosition profile_;
  Homing homing_;
  CyclicPosition cyclic_;
  PointBuffer points_;
  Motor motor_;
  Demand demand_;
  std::unique_ptr<AxisServo> servo_;  ///< nullptr: the motor is a simple lag
  double rated_acceleration_ = 0;     ///< acceleration at rated torque
  DriveState state_ = DriveState::not_ready;
  DriveState stopping_to_ = DriveState::operation_enabled;  ///< state after the ramp to standstill
  DriveMode mode_ = DriveMode::none;
  std::uint16_t controlword_ = 0;
  std::uint16_t fault_code_ = 0;
  bool settled_ = false;   ///< the controlword requests no further transition
  bool releases_ = false;  ///< the axis has torque, and is enabled when its brake has opened
  /// The axis is at the end of its travel, and its set-points would move it beyond this end.
  bool blocked_ = false;
  bool interpolates_ = false;  ///< with mechanics: the points of the buffer are being followed
  bool following_error_ = false;
  bool on_target_ = false;
  bool target_waits_ = false;
  Time time_{};
  Time published_ = never;  ///< time of the motion that the objects contain
  Time last_sync_{};
  Time sync_distance_{};
  Time following_time_{};
  Time target_time_{};
  Time initialised_at_ = never;
};

}  // namespace takt::sim
