#include <numbers>

#include "eds_parser/network_file/keys/sections.hpp"

namespace takt {
namespace {

/// Returns a number within the limits of its row, or std::nullopt after an error.
std::optional<double> number_within_limits(const KeyInput& in) {
  const RealRange& limits = in.key.value.numbers;
  const auto number = read_number(in.node, in.key.name, in.report());
  if (!number || limits.contains(*number)) return number;
  in.error("out-of-range", in.what(), " has to be from ", limits.low, " to ", limits.high, ", not ",
           in.node.text);
  return std::nullopt;
}

template <auto Member>
void bounded(const KeyInput& in, typename KeyTarget<decltype(Member)>::Type& out) {
  const auto number = number_within_limits(in);
  if (!number) return;
  const double value = *number;
  out.*Member = value;
}

template <auto Member, double Low, double High>
constexpr auto bounded_key(std::string_view name, std::string_view otherwise,
                           std::string_view meaning) {
  return key<bounded<Member>>(name, number_within({.low = Low, .high = High}), otherwise, meaning);
}

constexpr Key<MotorParameters> motor_keys[] = {
    bounded_key<&MotorParameters::inertia, 1e-8, 100.0>("inertia", "3e-5",
                                                        "kg m2, 1e-8 to 100: of the rotor."),
    bounded_key<&MotorParameters::rated_torque, 1e-4, 1e5>(
        "rated_torque", "1.27", "N m, 0.0001 to 1e5. The drive reports it in 0x6076."),
    bounded_key<&MotorParameters::peak_torque, 1e-4, 1e6>(
        "peak_torque", "3.81", "N m, 0.0001 to 1e6: the limit, whatever 0x6072 says."),
    bounded_key<&MotorParameters::max_speed, 1.0, 1e5>(
        "max_speed", "628",
        "rad/s, 1 to 1e5. Above nine tenths of it, the torque in the direction of motion falls."),
    bounded_key<&MotorParameters::friction, 0.0, 1e5>("friction", "0.02",
                                                      "N m, 0 to 1e5: dry friction."),
    bounded_key<&MotorParameters::breakaway, 1.0, 3.0>(
        "breakaway", "1",
        "1 to 3: ratio of the dry friction at rest to that in motion. Above 1, the axis hunts for "
        "its "
        "target."),
    bounded_key<&MotorParameters::viscosity, 0.0, 1e4>("viscosity", "2e-5",
                                                       "N m s/rad, 0 to 1e4: viscous friction."),
    bounded_key<&MotorParameters::current_lag, 1e-5, 0.1>(
        "current_lag", "0.00025", "s, 1e-5 to 0.1: time constant of the current controller."),
};

constexpr Key<LoadParameters> load_keys[] = {
    bounded_key<&LoadParameters::inertia, 1e-8, 1e4>(
        "inertia", "9e-5", "kg m2, 1e-8 to 1e4: of the load, at the shaft of the motor."),
    bounded_key<&LoadParameters::friction, 0.0, 1e5>("friction", "0.02",
                                                     "N m, 0 to 1e5: dry friction."),
    bounded_key<&LoadParameters::breakaway, 1.0, 3.0>(
        "breakaway", "1",
        "1 to 3: ratio of the dry friction at rest to that in motion. Above 1, the axis hunts for "
        "its "
        "target."),
    bounded_key<&LoadParameters::viscosity, 0.0, 1e4>("viscosity", "2e-5",
                                                      "N m s/rad, 0 to 1e4: viscous friction."),
    bounded_key<&LoadParameters::torque, -1e5, 1e5>(
        "torque", "0",
        "N m, -1e5 to 1e5: a constant torque, such as weight; above 0 towards higher counts."),
    bounded_key<&LoadParameters::stiffness, 1e-3, 1e12>(
        "stiffness", "none: a rigid coupling",
        "N m/rad, 0.001 to 1e12: of the coupling, which makes the load a second mass."),
    bounded_key<&LoadParameters::damping, 0.0, 1e9>("damping", "0",
                                                    "N m s/rad, 0 to 1e9: of the coupling."),
    bounded_key<&LoadParameters::backlash, 0.0, 10.0>(
        "backlash", "0", "rad, 0 to 10: of the coupling, from contact to contact."),
};

constexpr Key<ControllerParameters> controller_keys[] = {
    bounded_key<&ControllerParameters::position_gain, 0.1, 1000.0>(
        "position_gain", "80", "1/s, 0.1 to 1000: of the position controller."),
    bounded_key<&ControllerParameters::velocity_bandwidth, 1.0, 1000.0>(
        "velocity_bandwidth", "100",
        "Hz, 1 to 1000: of the velocity controller with motor and load."),
    bounded_key<&ControllerParameters::integral_time, 1e-4, 100.0>(
        "integral_time", "0.008", "s, 0.0001 to 100: of the velocity controller."),
    bounded_key<&ControllerParameters::velocity_feed_forward, 0.0, 1.0>(
        "velocity_feed_forward", "0",
        "0 to 1: part of the velocity of the set-points that the drive feeds forward by itself, "
        "besides 0x60B1."),
    bounded_key<&ControllerParameters::velocity_filter, 0.0, 0.1>(
        "velocity_filter", "0.00025", "s, 0 to 0.1: time constant of the measured velocity."),
};

constexpr Key<EncoderParameters> encoder_keys[] = {
    bounded_key<&EncoderParameters::increments, 16.0, 4294967296.0>(
        "increments", "131072", "16 to 4294967296: increments in a turn of the motor."),
    bounded_key<&EncoderParameters::dead_time, 0.0, 0.007>(
        "dead_time", "0", "s, 0 to 0.007: age of the position that the drive reports."),
};

constexpr Key<BrakeParameters> brake_keys[] = {
    bounded_key<&BrakeParameters::torque, 0.0, 1e6>(
        "torque", "0: no brake", "N m, 0 to 1e6: torque that the closed brake holds."),
    bounded_key<&BrakeParameters::opening, 0.0, 10.0>(
        "opening", "0.05", "s, 0 to 10: the axis is enabled when its brake has opened."),
    bounded_key<&BrakeParameters::closing, 0.0, 10.0>(
        "closing", "0.03",
        "s, 0 to 10: if the axis is at standstill, the drive holds it until its brake has closed."),
};

/// Reads `[lo, hi]`, in this order.
template <auto Member>
void read_zone(const KeyInput& in, TravelParameters& travel) {
  if (in.node.kind != YamlNode::Kind::sequence || in.node.items.size() != 2) {
    return in.error("wrong-type", in.what(), " has to be two positions: [-1.5, 1.5]");
  }
  const auto low = read_number(*in.node.items[0], in.key.name, in.report());
  const auto high = read_number(*in.node.items[1], in.key.name, in.report());
  if (!low || !high) return;
  if (*low >= *high) {
    return in.error("out-of-range", in.what(), " has to begin with the lower position");
  }
  travel.*Member = ZoneParameters{*low, *high};
}

template <auto Member>
constexpr auto zone_key(std::string_view name, std::string_view otherwise,
                        std::string_view meaning) {
  return key<read_zone<Member>>(name, {.type = KeyType::pair}, otherwise, meaning);
}

constexpr Key<TravelParameters> travel_keys[] = {
    zone_key<&TravelParameters::stops>("stops", "none", "Hard stops."),
    zone_key<&TravelParameters::switches>(
        "switches", "none", "The limit switches are active outside (0x60FD, bits 0 and 1)."),
    zone_key<&TravelParameters::home>("home", "at a random place before each homing",
                                      "The home switch is active inside (0x60FD, bit 2)."),
    zone_key<&TravelParameters::probe_1>(
        "probe_1", "none", "Input 1 of the touch probe is active inside (0x60FD, bit 16)."),
    zone_key<&TravelParameters::probe_2>("probe_2", "none", "The same for input 2 (bit 17)."),
    key<&TravelParameters::index>("index", {.type = KeyType::number}, "by the seed",
                                  "The position of one of the index pulses of the encoder."),
};

constexpr Key<MechanicsTable> mechanics_keys[] = {
    bounded_key<&MechanicsTable::turn, 1e-12, 1e12>(
        "turn", "2 pi if the unit is `rad`, 360 if it is `deg`, otherwise from 0x6091 and 0x6092",
        "Way of the axis in one turn of the motor, in the unit of `units: position`; above 0."),
    map_key<&MechanicsTable::motor, motor_keys>("motor", "400 W", "The motor."),
    map_key<&MechanicsTable::load, load_keys>("load", "3 times the motor", "What the motor moves."),
    map_key<&MechanicsTable::controller, controller_keys>("controller", "for the rigid default",
                                                          "The controllers of the drive."),
    map_key<&MechanicsTable::encoder, encoder_keys>("encoder", "17 bits", "At the motor."),
    map_key<&MechanicsTable::brake, brake_keys>("brake", "none", "At the motor."),
    map_key<&MechanicsTable::travel, travel_keys>(
        "travel", "none",
        "What the axis meets on its way: positions of the load before homing, in the unit of "
        "`units: position`."),
};

void check_whole(const KeyInput& in, const MechanicsTable& table) {
  const auto error = [&in](const auto&... parts) {
    in.error("out-of-range", in.what(), ": ", parts...);
  };
  const LoadParameters& load = table.load;
  if (!load.stiffness && (load.backlash > 0 || load.damping > 0)) {
    error("`backlash` and `damping` belong to a coupling that has a `stiffness`");
  }
  if (mechanics_steps(table) > most_mechanics_steps) {
    error("motor and load would swing with ", stiffest_mode(table) / (2 * std::numbers::pi),
          " Hz: leave out `stiffness` if the coupling is rigid, or lower it");
  }
  if (table.motor.peak_torque < table.motor.rated_torque) {
    error("`peak_torque` is below `rated_torque`");
  }
  const double fastest = std::numbers::pi * table.controller.velocity_bandwidth;
  if (table.controller.position_gain > fastest) {
    error("a `position_gain` above ", fastest,
          " swings, because the velocity controller is too slow for it");
  }
}

}  // namespace

void read_mechanics(const KeyInput& in, SimSpec& sim) {
  const std::size_t errors = in.report().errors();
  MechanicsTable table;
  read_map(in.node, in.what(), mechanics_keys, table, in.report());
  if (in.report().errors() != errors) return;
  check_whole(in, table);
  sim.mechanics = table;
}

KeyRows mechanics_rows() { return rows_of<mechanics_keys>(); }

}  // namespace takt
