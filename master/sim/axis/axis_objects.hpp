#pragma once
#include <cassert>
#include <cstdint>
#include <vector>

#include "master/sim/dictionary/object_store.hpp"

namespace takt::sim {

/// A numeric object of the dictionary, or a constant if the device does not have the object. For a
/// constant, set() has no effect, and may be called only if the constant is 0.
class Slot {
 public:
  Slot(ObjectStore& store, ObjectKey key, std::int64_t missing = 0)
      : object_{&store.number_or(key, missing)} {}
  std::int64_t get() const noexcept { return object_->number(); }
  /// Returns the value, or `other` if the parameter is missing or not above zero (unset).
  double positive_or(double other) const noexcept {
    const std::int64_t value = get();
    return value > 0 ? static_cast<double>(value) : other;
  }
  void set(std::int64_t value) noexcept {
    assert(exists() || object_->value == 0);
    object_->set(static_cast<std::uint64_t>(value));
  }
  bool exists() const noexcept { return !object_->is_bytes(); }
  bool is(const Object& object) const noexcept { return object_ == &object; }

 private:
  Object* object_;
};

/// The objects of one axis. The objects of axis n lie 0x800 x n above those of axis 0. CiA 402-2.
class AxisObjects {
 private:
  Slot at(unsigned index, std::uint8_t sub = 0, std::int64_t missing = 0) const;
  std::vector<Slot> list_at(unsigned index) const;

  ObjectStore& store_;
  std::uint16_t offset_;

 public:
  AxisObjects(ObjectStore& store, std::uint16_t offset);

  Slot abort_connection;
  Slot error_code;
  Slot controlword;
  Slot statusword;
  Slot quick_stop_option;
  Slot shutdown_option;
  Slot disable_option;
  Slot halt_option;
  Slot fault_option;
  Slot mode;
  Slot mode_display;
  Slot supported_modes;
  Slot position_demand;
  Slot position_actual;
  Slot position_demand_internal;
  Slot position_actual_internal;
  Slot following_window;
  Slot following_timeout;
  Slot position_window;
  Slot position_time;
  Slot target_position;
  Slot home_offset;
  Slot limit_min;
  Slot limit_max;
  Slot max_profile_velocity;
  Slot profile_velocity;
  Slot profile_acceleration;
  Slot profile_deceleration;
  Slot quick_stop_deceleration;
  Slot velocity_demand;
  Slot velocity_actual;
  Slot velocity_window;
  Slot velocity_threshold;
  Slot target_velocity;
  Slot target_torque;
  Slot max_torque;
  Slot max_current;
  Slot torque_demand;
  Slot rated_torque;
  Slot torque_actual;
  Slot current_actual;
  Slot max_motor_speed;
  Slot torque_slope;
  Slot homing_method;
  Slot homing_speed_switch;
  Slot homing_speed_zero;
  Slot homing_acceleration;
  std::vector<Slot> homing_methods;  ///< objects with the methods that the drive lists in 0x60E3
  Slot position_offset;
  Slot velocity_offset;
  Slot torque_offset;
  Slot interpolation_target;
  Slot buffer_max_size;
  Slot buffer_size;
  Slot buffer_position;
  Slot buffer_clear;
  Slot period_value;
  Slot period_exponent;
  Slot max_acceleration;
  Slot positive_torque_limit;
  Slot negative_torque_limit;
  Slot positioning_option;
  Slot following_error;
  Slot digital_inputs;
  Slot probe_function;
  Slot probe_status;
  Slot probe_1_rising;
  Slot probe_1_falling;
  Slot probe_2_rising;
  Slot probe_2_falling;
};

}  // namespace takt::sim
