#pragma once
#include "eds_parser/network_file/yaml/key_table.hpp"
#include "eds_parser/specification/network_spec.hpp"

namespace takt {

// The tables of keys of a network file, one function or row for each section. All readers report
// errors and continue.

inline constexpr KeyOrigin bus_yml = KeyOrigin::bus_yml;

/// Returns the table of the top-level keys of the network file.
std::span<const Key<NetworkSpec>> network_keys() noexcept;

/// The end of the message about an unknown key in a map that has `driver`. ros2_canopen passes the
/// whole map to the class that `driver` names, so this class may read the key.
inline constexpr std::string_view driver_key =
    ": takt has no key of this name and ignores it; the class of `driver` may read it";
inline constexpr std::string_view other_reader = "only other programs read it";

/// Keys of ros2_canopen that the master and the nodes may have.
template <class T>
inline constexpr Key<T> ros_keys[] = {
    foreign<T>("driver",
               "it names the C++ class of a ROS 2 driver; takt needs no driver, profiles follow "
               "from the device"),
    foreign<T>("package", "it is the ROS 2 package of the driver"),
    foreign<T>("namespace remappings",
               "ROS 2 names; LCM channels are named after the bus and the node"),
    foreign<T>("polling", "ROS 2 publishing; the image is published every cycle"),
    foreign<T>("period",
               "rate of a ROS 2 timer; the cycle is `sync_period`, or `cycle` of `master`"),
    foreign<T>("non_transmit_timeout",
               "it is for the ROS 2 driver; in takt `realtime: receive_window_us` decides when a "
               "PDO is late"),
    foreign<T>("diagnostics", "ROS 2 diagnostics; in takt `takt status` and BUS_STATUS show them"),
    foreign<T>("boot_timeout", "it is for the ROS 2 driver; the key of takt is `boot_timeout_ms`"),
};

void read_master(const KeyInput& in, NetworkSpec& spec);
KeyRows master_rows();

/// Reads one node. Keys of `defaults` that the node does not have itself are already merged into
/// it.
NodeSpec read_node(const YamlNode& node, const std::string& name, SourcePos pos,
                   NetworkReport& report);
KeyRows node_rows();

/// Reads `tpdo` or `rpdo` of a node.
void read_pdos(const KeyInput& in, std::vector<PdoSpec>& pdos);
KeyRows pdo_rows();

/// Reads a list of `{index, sub_index, value}`. An object that appears twice without `again: true`
/// is a warning in `sdo`, whose entries are written in order, and an error in other lists.
void read_objects(const KeyInput& in, std::vector<SdoSpec>& objects);
KeyRows object_rows();

void read_units(const KeyInput& in, NodeSpec& node);
KeyRows units_rows();
void read_limits(const KeyInput& in, NodeSpec& node);
KeyRows limits_rows();
/// Reads `homing`, which is a map or only the method.
void read_homing(const KeyInput& in, NodeSpec& node);
KeyRows homing_rows();
void read_feed_forward(const KeyInput& in, NodeSpec& node);
KeyRows feed_forward_rows();
/// Reads `mechanics` of `sim`, and checks that the parameters fit together.
void read_mechanics(const KeyInput& in, SimSpec& sim);
KeyRows mechanics_rows();
/// Reads `speed_axis` of a node or of the device data.
void read_speed_axis(const KeyInput& in, SpeedAxisSpec& axis);
KeyRows speed_axis_rows();

/// Reads `heartbeat_consumer`. Other programs take each number except 0 as true, and some files
/// state a time in ms here, so any number is accepted.
void read_consumer(const KeyInput& in, Sourced<bool>& consumer);
/// Reads `heartbeat_producer`. A word for "no" gives 0 with a warning.
void read_producer(const KeyInput& in, Sourced<std::uint16_t>& producer);
/// Reads a bit rate in kbit/s. The name `baudrate` does not state a unit, so a value that can only
/// be meant in bit/s is converted.
void read_bit_rate(const KeyInput& in, Sourced<std::uint32_t>& rate);
/// The smallest `heartbeat_multiplier` leaves room for one late heartbeat.
inline constexpr KeyValue multiplier_value = number_within({.low = 1.5});
/// Reads `heartbeat_multiplier`.
void read_multiplier(const KeyInput& in, Sourced<double>& multiplier);

/// Makes a function for a row that reads a member of `T` with one of the functions above.
template <auto Read, auto Member>
void with(const KeyInput& in, typename KeyTarget<decltype(Member)>::Type& target) {
  Read(in, target.*Member);
}

/// Makes the rows `index` and `sub_index` of an entry for one object.
template <class T>
constexpr Key<T> index_key() {
  return required(key<&T::object, &ObjectKey::index>("index", whole(1, 0xFFFF), "",
                                                     "The index of the object.", bus_yml));
}
template <class T>
constexpr Key<T> sub_index_key() {
  return key<&T::object, &ObjectKey::sub>("sub_index", "0", "The sub-index.", bus_yml);
}

}  // namespace takt
