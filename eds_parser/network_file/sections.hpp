#pragma once
#include "eds_parser/network_file/map_reader.hpp"
#include "eds_parser/specification/network_spec.hpp"

namespace takt {

// One function reads each section of a network file. All of them report errors and go on.

void read_bus(const YamlNode& node, NetworkSpec& spec, NetworkReport& report);
void read_options(const YamlNode& node, NetworkSpec& spec, NetworkReport& report);
void read_master(const YamlNode& node, NetworkSpec& spec, NetworkReport& report);
void read_realtime(const YamlNode& node, NetworkSpec& spec, NetworkReport& report);
void read_black_box(const YamlNode& node, NetworkSpec& spec, NetworkReport& report);
void read_lcm(const YamlNode& node, NetworkSpec& spec, NetworkReport& report);

/// Message for unknown keys beside `driver`. ros2_canopen passes the whole map to the class named
/// there.
inline constexpr std::string_view driver_key =
    ": takt has no key of this name and ignores it; the class of `driver` may read it";

/// Reads one node. Keys of `defaults` that the node does not have itself are already merged into
/// it.
NodeSpec read_node(const YamlNode& node, const std::string& name, SourcePos pos,
                   NetworkReport& report);

/// Reads `tpdo:` or `rpdo:` of a node. `key` is "tpdo" or "rpdo".
std::vector<PdoSpec> read_pdos(const YamlNode& node, std::string_view key, const std::string& owner,
                               NetworkReport& report);
/// Reads a list of `{index, sub_index, value}`. An object that appears twice without `again: true`
/// is a warning in `sdo`, whose entries are written in order, and an error in other lists.
std::vector<SdoSpec> read_objects(const YamlNode& node, std::string_view key,
                                  const std::string& owner, NetworkReport& report);
UnitsSpec read_units(const YamlNode& node, const std::string& owner, NetworkReport& report);
LimitsSpec read_limits(const YamlNode& node, const std::string& owner, NetworkReport& report);

/// Reads `index` and `sub_index` of a list entry. Returns std::nullopt after an error, which it
/// reports.
std::optional<ObjectKey> read_object_key(MapReader& reader, SourcePos pos);

/// Reads `heartbeat_consumer` and `heartbeat_producer` of the master or of a node.
void read_heartbeat_ends(MapReader& reader, Sourced<bool>& consumer,
                         Sourced<std::uint16_t>& producer);

/// Reads `sdo_block`, `sdo_channel` and `sdo_timeouts` of a node.
void read_sdo_access(MapReader& reader, NodeSpec& node);

}  // namespace takt
