#include "master/sim/axis/axis_objects.hpp"

namespace takt::sim {
namespace {

constexpr std::int64_t off = 0xFFFF'FFFF;

}  // namespace

Slot AxisObjects::at(unsigned index, std::uint8_t sub, std::int64_t missing) const {
  return {store_, {static_cast<std::uint16_t>(index + offset_), sub}, missing};
}

/// Returns the elements of an array, from sub-index 1 on.
std::vector<Slot> AxisObjects::list_at(unsigned index) const {
  std::vector<Slot> elements;
  for (std::uint8_t sub = 1; sub < 0xFF; ++sub) {
    const Slot element = at(index, sub);
    if (!element.exists()) break;
    elements.push_back(element);
  }
  return elements;
}

AxisObjects::AxisObjects(ObjectStore& store, std::uint16_t offset)
    : store_{store},
      offset_{offset},
      abort_connection{at(0x6007, 0, 1)},
      error_code{at(0x603F)},
      controlword{at(0x6040)},
      statusword{at(0x6041)},
      quick_stop_option{at(0x605A, 0, 2)},
      shutdown_option{at(0x605B)},
      disable_option{at(0x605C, 0, 1)},
      halt_option{at(0x605D, 0, 1)},
      fault_option{at(0x605E, 0, 2)},
      mode{at(0x6060)},
      mode_display{at(0x6061)},
      supported_modes{at(0x6502)},
      position_demand{at(0x6062)},
      position_actual{at(0x6064)},
      position_demand_internal{at(0x60FC)},
      position_actual_internal{at(0x6063)},
      following_window{at(0x6065, 0, off)},
      following_timeout{at(0x6066)},
      position_window{at(0x6067, 0, 10)},
      position_time{at(0x6068)},
      target_position{at(0x607A)},
      home_offset{at(0x607C)},
      limit_min{at(0x607D, 1)},
      limit_max{at(0x607D, 2)},
      max_profile_velocity{at(0x607F)},
      profile_velocity{at(0x6081)},
      profile_acceleration{at(0x6083)},
      profile_deceleration{at(0x6084)},
      quick_stop_deceleration{at(0x6085)},
      velocity_demand{at(0x606B)},
      velocity_actual{at(0x606C)},
      velocity_window{at(0x606D, 0, 10)},
      velocity_threshold{at(0x606F, 0, 10)},
      target_velocity{at(0x60FF)},
      target_torque{at(0x6071)},
      max_torque{at(0x6072)},
      max_current{at(0x6073)},
      torque_demand{at(0x6074)},
      rated_torque{at(0x6076)},
      torque_actual{at(0x6077)},
      current_actual{at(0x6078)},
      max_motor_speed{at(0x6080)},
      torque_slope{at(0x6087)},
      homing_method{at(0x6098)},
      homing_speed_switch{at(0x6099, 1)},
      homing_speed_zero{at(0x6099, 2)},
      homing_acceleration{at(0x609A)},
      homing_methods{list_at(0x60E3)},
      position_offset{at(0x60B0)},
      velocity_offset{at(0x60B1)},
      torque_offset{at(0x60B2)},
      interpolation_target{at(0x60C1, 1)},
      buffer_max_size{at(0x60C4, 1)},
      buffer_size{at(0x60C4, 2)},
      buffer_position{at(0x60C4, 4)},
      buffer_clear{at(0x60C4, 6, 1)},
      period_value{at(0x60C2, 1)},
      period_exponent{at(0x60C2, 2)},
      max_acceleration{at(0x60C5)},
      positive_torque_limit{at(0x60E0)},
      negative_torque_limit{at(0x60E1)},
      positioning_option{at(0x60F2)},
      following_error{at(0x60F4)},
      digital_inputs{at(0x60FD)},
      probe_function{at(0x60B8)},
      probe_status{at(0x60B9)},
      probe_1_rising{at(0x60BA)},
      probe_1_falling{at(0x60BB)},
      probe_2_rising{at(0x60BC)},
      probe_2_falling{at(0x60BD)} {}

}  // namespace takt::sim
