#pragma once
#include "eds_parser/network_file/map_reader.hpp"
#include "eds_parser/network_spec.hpp"

namespace takt {

// The sections of a network file, one function each. All report and go on.

void read_bus(const YamlNode& node, NetworkSpec& spec, NetworkReport& report);
void read_options(const YamlNode& node, NetworkSpec& spec, NetworkReport& report);
void read_master(const YamlNode& node, NetworkSpec& spec, NetworkReport& report);
void read_realtime(const YamlNode& node, NetworkSpec& spec, NetworkReport& report);
void read_black_box(const YamlNode& node, NetworkSpec& spec, NetworkReport& report);
void read_lcm(const YamlNode& node, NetworkSpec& spec, NetworkReport& report);

/// Of unknown keys beside `driver`: ros2_canopen hands the whole map to the class named there.
inline constexpr std::string_view driver_key =
    ": takt reads none of that name and leaves it alone; the class of `driver` may read it";

/// One node; keys that it does not have itself are already merged in from `defaults`.
NodeSpec read_node(const YamlNode& node, const std::string& name, SourcePos pos,
                   NetworkReport& report);

/// `tpdo:` or `rpdo:` of a node. `key` is "tpdo" or "rpdo".
std::vector<PdoSpec> read_pdos(const YamlNode& node, std::string_view key, const std::string& owner,
                               NetworkReport& report);
/// A list of `{index, sub_index, value}`; an object twice is told unless it says `again: true`: in
/// `sdo`, which is written in order, as a warning, else as an error.
std::vector<SdoSpec> read_objects(const YamlNode& node, std::string_view key,
                                  const std::string& owner, NetworkReport& report);
UnitsSpec read_units(const YamlNode& node, const std::string& owner, NetworkReport& report);
LimitsSpec read_limits(const YamlNode& node, const std::string& owner, NetworkReport& report);

/// `index` and `sub_index` of a list entry; none: reported.
std::optional<ObjectKey> read_object_key(MapReader& reader, SourcePos pos);

/// `heartbeat_consumer` and `heartbeat_producer` of the master or of a node.
void read_heartbeat_ends(MapReader& reader, Sourced<bool>& consumer,
                         Sourced<std::uint16_t>& producer);

/// `sdo_block`, `sdo_channel`, `sdo_timeouts` of a node.
void read_sdo_access(MapReader& reader, NodeSpec& node);

}  // namespace takt
