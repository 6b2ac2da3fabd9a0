#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "eds_parser/dictionary/object_dictionary.hpp"
#include "eds_parser/plan/pdo/cob_ids.hpp"
#include "eds_parser/plan/pdo/effective_pdo.hpp"
#include "eds_parser/report/network_report.hpp"
#include "eds_parser/specification/network_spec.hpp"
#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/table/device_table.hpp"

namespace takt {

// The parts of the compilation of a network, in their order.

/// Compiles `sync_source`, its timeout and the reaction to a loss of SYNC, if the master does not
/// produce SYNC itself.
void compile_sync_source(const NetworkSpec& spec, const std::vector<NodePdos>& nodes, BusPlan& plan,
                         NetworkReport& report);

/// COB-IDs that services of the network use, each with a phrase for messages: "is TIME".
using ServiceIds = std::map<CobId, std::string>;

/// Returns the COB-IDs of SYNC, TIME, EMCY and the SDO channels of the nodes. Two users of one
/// identifier are reported. Identifiers that CiA 301 reserves in all networks (is_restricted()) are
/// not listed.
ServiceIds service_ids(const NetworkSpec& spec, std::span<const NodePdos> nodes,
                       NetworkReport& report);

/// Returns the EMCY identifier of a node from the network file, else from the device file. Returns
/// std::nullopt for the predefined 0x080 + node-ID, and if EMCY is off.
std::optional<CobId> emcy_cob_id(const NodeSource& node);

/// Warns of event timers that contradict the inhibit time, and of inhibit times that are shorter
/// than the frame on the wire. `bitrate` is in bit/s.
void judge_pdo_times(const NodePdos& node, std::uint32_t bitrate, NetworkReport& report);

/// Returns true if the node is a CiA 402 drive, according to `profile:` of the network file, else
/// the device file.
bool is_cia402(const NodeSource& node);

/// Warns if the network file does not say which object sets the mode of operation of an axis, or
/// what the other CiA 402 drives do when one drive is lost.
void ask_about_drives(std::span<const NodePdos> nodes, NetworkReport& report);

/// Warns if the points of interpolated position mode do not come as often as a drive takes them, so
/// that its buffer runs empty or full.
void judge_interpolation(const NodePdos& node, std::uint32_t sync_period_us, NetworkReport& report);

/// Returns how a node gets its node-ID by LSS, or std::nullopt if the network file does not ask for
/// LSS. `others` holds the nodes before this one.
std::optional<LssPlan> compile_lss(const NodeSpec& node, const ObjectDictionary& dictionary,
                                   std::span<const NodePlan> others, NetworkReport& report);

/// Returns the CiA 402 axes of a device in the form that the ordered stop needs. The values are
/// those that the device has after its boot: the values of its device file, overwritten by the boot
/// plan. `source` supplies the units and limits of the node.
std::vector<AxisPlan> compile_axes(const NodePlan& node, const DeviceTable& device,
                                   const NodeSource& source, NetworkReport& report);

/// Returns the longest stopping time of all axes of `plan`. 0 means that no stopping time is known.
Time longest_stopping_time(const BusPlan& plan) noexcept;

/// Warns if the ordered stop gives a drive less time than its ramp needs, and if the standstill of
/// a drive can not be confirmed because the drive coasts.
void judge_stop(const BusPlan& plan, const NetworkSpec& spec, NetworkReport& report);

/// Warns if `feed_forward` of an axis has no effect, and notes a torque offset (60B2) in an RPDO
/// that the motions of the axis do not command.
void judge_feed_forward(const BusPlan& plan, const NetworkSpec& spec, NetworkReport& report);

}  // namespace takt
