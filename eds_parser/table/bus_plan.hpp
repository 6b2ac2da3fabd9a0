#pragma once
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "eds_parser/table/boot_plan.hpp"
#include "eds_parser/table/firmware.hpp"
#include "eds_parser/table/image_layout.hpp"
#include "eds_parser/table/lss_plan.hpp"
#include "eds_parser/table/output_limits.hpp"
#include "eds_parser/table/pdo_table.hpp"
#include "eds_parser/table/sdo_access.hpp"
#include "eds_parser/table/speed_axis.hpp"
#include "eds_parser/values/ids.hpp"
#include "eds_parser/values/time.hpp"

namespace takt {

/// The meaning of one emergency error code of a device family.
struct EmcyText {
  std::uint16_t code = 0;
  std::string text;
};

/// Node guarding of a device that has no heartbeat. CiA 301, 7.2.8.3.2.1.
struct GuardPlan {
  Time period{};             ///< time between two guarding requests; 0 = not guarded
  std::uint8_t retries = 3;  ///< number of silent periods after which the node is lost
  Time life_time() const noexcept { return period * retries; }
};

/// One entry of a device's heartbeat consumer list, 0x1016.
struct HeartbeatConsumer {
  NodeId producer;
  Time longest{};  ///< longest silence of the producer that the device accepts
};

/// The reaction of the master, besides the report, when a node that was ready falls silent.
enum class LossReaction : std::uint8_t {
  report,      ///< nothing more; the node is booted again when it is back
  stop_node,   ///< NMT stop to the node; it stays stopped until it is reset or started on request
  stop_group,  ///< NMT stop to every node of its group
  quick_stop,  ///< the drives of its group, or of the bus if it has none, stop and are disabled
};

/// The effect of the loss of a mandatory node on the other nodes. 0x1F80 bits 4 and 6, CiA 302-2.
enum class MandatoryLoss : std::uint8_t { only_it, reset_all, stop_all };

/// Start-up of the network: 0x1F80, 0x1F89, 0x102A. CiA 302-2.
struct StartUpPlan {
  bool start_master = true;  ///< the master enters OPERATIONAL by itself (0x1F80 bit 2, inverted)
  bool start_all = false;    ///< one broadcast starts all nodes (0x1F80 bit 1)
  MandatoryLoss on_loss = MandatoryLoss::only_it;
  Time boot_time{};    ///< longest boot of all mandatory nodes together; 0 = no limit
  Time nmt_inhibit{};  ///< shortest time between two NMT commands
};

/// A statement that applies only to a range of firmware versions of a device.
struct FirmwareRule {
  std::optional<Firmware> from{};  ///< first version to which the rule applies, if limited
  /// First version to which the rule no longer applies, if limited.
  std::optional<Firmware> below{};
  std::string text{};  ///< "these objects are missing: 1403"

  bool holds(const Firmware& version) const noexcept {
    return (!from || version >= *from) && (!below || version < *below);
  }
};

/// The firmware version that the plan assumes for a device, and the rules that depend on it.
struct FirmwarePlan {
  Firmware assumed{};
  ObjectKey object{};  ///< object that holds the version: 0x1018:03, else 0x100A
  std::vector<FirmwareRule> rules{};

  bool of_revision() const noexcept { return object.index == 0x1018; }
};

/// The unit of a raw value. The value in this unit is raw x scale; `unit` is empty if the network
/// file gives none.
struct RawUnit {
  double scale = 1.0;
  std::string unit{};
};

/// Values of `homing:` of an axis in the network file that the plan keeps. The boot writes the
/// others.
struct HomingPlan {
  bool required = true;                    ///< An absolute motion needs homing first.
  Time timeout{std::chrono::seconds{60}};  ///< longest time of a homing run
  std::optional<std::int8_t> method{};     ///< 0x6098; empty: the method that the device has
};

/// `feed_forward:` of an axis in the network file, in the units of its signals.
struct FeedForwardPlan {
  double torque_per_acceleration = 0.0;
  double torque_per_velocity = 0.0;
};

/// One CiA 402 axis of a device, with the data for its ordered stop. Values are raw units of the
/// device.
struct AxisPlan {
  std::uint8_t number = 0;  ///< counts from 0; the axis's objects are 0x800 x number higher
  /// Window of 0x606C; at lower speeds the axis counts as standing still.
  std::int64_t velocity_window = 10;
  /// Change of 0x6064 in 50 ms below which the axis counts as standing still.
  std::int64_t position_window = 10;
  /// Time of a quick stop from the velocity limit of the axis; 0 = not known.
  Time stopping_time{};
  std::int16_t quick_stop_option = 2;  ///< 0x605A; the boot reads the value of the device
  std::uint16_t ramp_object = 0;       ///< 0x6085 or 0x6084; 0 = not known
  RawUnit velocity_unit{};             ///< unit of 0x606C
  RawUnit position_unit{};             ///< unit of differences of 0x6064
  std::optional<HomingPlan> homing{};  ///< empty: the network file has no `homing` for the axis
  std::optional<FeedForwardPlan> feed_forward{};  ///< empty: motions do not command 0x60B2
};

/// One device from the view of the master.
struct NodePlan {
  std::string name;  ///< name in the network file: "shoulder"
  NodeId id;
  std::string description_file{};  ///< EDS or DCF, as written in the network file
  std::string product_name{};
  bool boot = true;        ///< false: the master only watches it, without NMT and SDO
  bool mandatory = false;  ///< the failure of the node ends taktd with exit code 4
  bool cia402 = false;     ///< axis features: ordered stop, quick stop fallback
  BootPlan boot_plan{};
  std::optional<LssPlan> lss{};  ///< how the node gets its node-ID by LSS if it has none
  Time heartbeat_timeout{};      ///< longest silence; 0 = not watched
  GuardPlan guard{};             ///< guarding; only for a node without heartbeat
  Time heartbeat_period{};       ///< producer time of the device; 0 = not known
  std::vector<HeartbeatConsumer> watches{};  ///< heartbeat consumers of the device after the boot
  bool consumes_master = true;  ///< `heartbeat_consumer`: the device may watch the master
  Time life_guarding{};         ///< longest pause of guarding that the device accepts; 0 = no limit
  std::optional<CobId> emcy_cob_id{};  ///< empty = 0x080 + node-ID
  /// The node is started by StartUpPlan::start_all, not by its boot plan.
  bool start_later = false;
  LossReaction on_loss = LossReaction::report;
  std::uint8_t group = 0;  ///< index into BusPlan::groups + 1; 0 = no group
  Time sdo_timeout{};      ///< timeout of SDO requests; boot steps have their own limits
  SdoAccess sdo{};
  Time reboot_delay{};             ///< pause before a failed boot is tried again; doubles each time
  Time longest_reboot_delay{};     ///< longest pause before a failed boot is tried again
  std::string device_data{};       ///< entry of the device data that applies: "Lenze 8400 HighLine"
  std::string device_data_file{};  ///< "lenze8400.yaml"
  /// Notes of the entry of the device data, one line each.
  std::vector<std::string> device_notes{};
  std::vector<EmcyText> emcy_texts{};  ///< error codes of this device family
  std::optional<FirmwarePlan> firmware{};
  /// Reaction of devices of this family to SYNC loss; empty = not known.
  std::string on_sync_loss{};
  std::vector<AxisPlan> axes{};

  /// Returns the longest wait of the master for the answer to a request for this object.
  Time sdo_timeout_of(ObjectKey object) const noexcept {
    return sdo.timeout_of(object, sdo_timeout > Time{} ? sdo_timeout : std::chrono::seconds{1});
  }
};

/// The reaction of the master, besides the report, when the SYNC of another device stops.
enum class SyncLoss : std::uint8_t {
  hold,      ///< no outputs are sent, so the devices keep their last values
  fallback,  ///< commanded outputs take their fallback, as when their commands expire
  stop,      ///< NMT stop to all nodes except the producer; NMT start when SYNC is back
};

/// The way in which the master disarms the supervision in the devices at the end of a confirmed
/// ordered stop.
enum class StopDisarm : std::uint8_t {
  sdo,                  ///< 0 is written to 0x1016, 0x1006, 0x100C and 0x100D
  reset_communication,  ///< NMT reset communication is the last command
};

/// SYNC and the times of a cycle. All times count from SYNC.
struct CyclePlan {
  Time period{};               ///< period of SYNC, or of the image if there is no SYNC
  bool sync = true;            ///< false: there is no SYNC
  bool sync_followed = false;  ///< another device sends SYNC
  /// Device that produces SYNC, if the network file names it.
  std::optional<NodeId> sync_producer{};
  Time sync_timeout{};  ///< silence after which a followed SYNC counts as lost
  SyncLoss on_sync_loss = SyncLoss::fallback;
  CobId sync_cob_id = CobId::base(0x080);
  std::uint8_t sync_overflow = 0;  ///< 0x1019; 0 = SYNC without counter
  Time receive_window{};           ///< an expected PDO that comes later counts as missing
  Time output_deadline{};          ///< the master begins to send the outputs at this time
  Time quiet_before_sync{};  ///< time before SYNC in which no frame of the master is on the wire
  Time sync_window{};        ///< synchronous window (0x1007) of the devices; 0 = none
  std::uint16_t service_frames = 4;  ///< greatest number of SDO and NMT frames in a cycle

  /// Returns the time by which the SYNC of another device may be early or late in each period.
  Time followed_tolerance() const noexcept { return period / 20; }

  bool makes_sync() const noexcept { return sync && !sync_followed; }
};

/// The master as producer of TIME. CiA 301, 7.2.6.
struct TimePlan {
  Time period{};  ///< 0 = the master does not send TIME
  CobId cob_id = CobId::base(0x100);
};

/// All data of a bus that the master needs. The plan is compiled and printable, and it does not
/// change while the master runs.
struct BusPlan {
  std::string name;                   ///< "lift"; LCM channels use it in capitals
  std::string interface{};            ///< "can0"; empty = simulated bus
  std::uint32_t bitrate = 1'000'000;  ///< bit/s
  NodeId master_id = NodeId::from(127).value();
  Time master_heartbeat{};  ///< heartbeat producer time of the master; 0 = none
  bool start_nodes = true;  ///< the master sends NMT start after boot
  StartUpPlan start_up{};
  std::vector<std::string> groups{};  ///< names of the node groups
  CyclePlan cycle{};
  TimePlan time{};
  ImageLayout layout{};
  PdoTable pdos{};
  std::vector<SpeedAxisPlan> speed_axes{};  ///< in ascending order of node-ID
  LimitsPlan limits{};
  std::vector<NodePlan> nodes{};                ///< in ascending order of node-ID
  Time stop_timeout = std::chrono::seconds{5};  ///< limit of the whole ordered stop
  StopDisarm stop_disarm = StopDisarm::sdo;

  /// Returns the position in `nodes`, or nodes.size() if no node with this id is planned.
  std::size_t index_of(unsigned id) const noexcept {
    const auto found =
        std::ranges::find(nodes, id, [](const NodePlan& node) { return node.id.value(); });
    return static_cast<std::size_t>(found - nodes.begin());
  }
  /// Returns null if no node with this id is planned.
  const NodePlan* find(unsigned id) const noexcept {
    const std::size_t index = index_of(id);
    return index == nodes.size() ? nullptr : &nodes[index];
  }
};

}  // namespace takt
