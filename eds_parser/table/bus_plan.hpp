#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "eds_parser/table/boot_plan.hpp"
#include "eds_parser/table/firmware.hpp"
#include "eds_parser/table/ids.hpp"
#include "eds_parser/table/image_layout.hpp"
#include "eds_parser/table/lss_plan.hpp"
#include "eds_parser/table/output_limits.hpp"
#include "eds_parser/table/pdo_table.hpp"
#include "eds_parser/table/sdo_access.hpp"
#include "eds_parser/table/time.hpp"

namespace takt {

/// An error code of one device family in words.
struct EmcyText {
  std::uint16_t code = 0;
  std::string text;
};

/// Node guarding of a device that has no heartbeat. CiA 301, 7.2.8.3.2.1.
struct GuardPlan {
  Time period{};             ///< between two requests; 0 = not guarded
  std::uint8_t retries = 3;  ///< silence of so many periods is a loss
  Time life_time() const noexcept { return period * retries; }
};

/// Somebody whose heartbeats a device watches: 0x1016.
struct HeartbeatConsumer {
  NodeId producer;
  Time longest{};  ///< silence that it takes
};

/// What the master does when a node that was ready falls silent, beyond telling it.
enum class LossReaction : std::uint8_t {
  report,      ///< nothing; it is booted again when it is back
  stop_node,   ///< NMT stop to it; it stays away until somebody resets or starts it
  stop_group,  ///< the same for every node of its group
  quick_stop,  ///< the drives of its group (without a group: of the bus) stop and are disabled
};

/// What the loss of a mandatory node means to the others. 0x1F80 bits 4 and 6, CiA 302-2.
enum class MandatoryLoss : std::uint8_t { only_it, reset_all, stop_all };

/// Start-up of the network: 0x1F80, 0x1F89, 0x102A. CiA 302-2.
struct StartUpPlan {
  bool start_master = true;  ///< the master becomes operational by itself (bit 2 inverse)
  bool start_all = false;    ///< nodes are started by one broadcast (bit 1)
  MandatoryLoss on_loss = MandatoryLoss::only_it;
  Time boot_time{};    ///< of all mandatory nodes; 0 = no limit
  Time nmt_inhibit{};  ///< least time between two NMT commands
};

/// Something that holds for some versions of a device's firmware only.
struct FirmwareRule {
  std::optional<Firmware> from{};
  std::optional<Firmware> below{};
  std::string text{};  ///< "these objects are missing: 1403"

  bool holds(const Firmware& version) const noexcept {
    return (!from || version >= *from) && (!below || version < *below);
  }
};

/// What the plan takes a device's firmware for, and what depends on it.
struct FirmwarePlan {
  Firmware assumed{};
  ObjectKey object{};  ///< 0x1018:03, else 0x100A
  std::vector<FirmwareRule> rules{};

  bool of_revision() const noexcept { return object.index == 0x1018; }
};

/// One CiA 402 axis of a device, for the ordered stop. Raw units of the device.
struct AxisPlan {
  std::uint8_t number = 0;             ///< counts from 0; its objects lie 0x800 x number higher
  std::int64_t velocity_window = 10;   ///< of 0x606C: below it the axis counts as standing still
  std::int64_t position_window = 10;   ///< of 0x6064, the same, within 50 ms
  Time stopping_time{};                ///< of a quick stop from its velocity limit; 0: not known
  std::int16_t quick_stop_option = 2;  ///< 0x605A
  std::uint16_t ramp_object = 0;       ///< 0x6085 or 0x6084; 0: not known
};

/// One device as the master sees it.
struct NodePlan {
  std::string name;  ///< from the network file: "shoulder"
  NodeId id;
  std::string description_file{};  ///< EDS or DCF, as written in the network file
  std::string product_name{};
  bool boot = true;        ///< false: only watched, no NMT, no SDO
  bool mandatory = false;  ///< its failure ends taktd with exit code 4
  bool cia402 = false;     ///< axis features: ordered stop, quick stop fallback
  BootPlan boot_plan{};
  std::optional<LssPlan> lss{};              ///< gets its id by LSS where it has none
  Time heartbeat_timeout{};                  ///< longest silence; 0 = not watched
  GuardPlan guard{};                         ///< only where there is no heartbeat
  Time heartbeat_period{};                   ///< of the device; 0 = not known
  std::vector<HeartbeatConsumer> watches{};  ///< once it has booted
  Time life_guarding{};                ///< silence of the master's guarding that it takes; 0 = any
  std::optional<CobId> emcy_cob_id{};  ///< none: 0x080 + id
  bool start_later = false;  ///< with the network (StartUpPlan::start_all), not by the boot plan
  LossReaction on_loss = LossReaction::report;
  std::uint8_t group = 0;  ///< index into BusPlan::groups + 1; 0 = none
  Time sdo_timeout{};      ///< of requests while running
  SdoAccess sdo{};
  Time reboot_delay{};          ///< pause before a failed boot is tried again; it doubles up to ...
  Time longest_reboot_delay{};  ///< ... this, while the boot fails
  std::string device_data{};    ///< entry that was applied: "Lenze 8400 HighLine"
  std::string device_data_file{};           ///< "lenze8400.yaml"
  std::vector<std::string> device_notes{};  ///< what it says, a line each
  std::vector<EmcyText> emcy_texts{};       ///< of this device family
  std::optional<FirmwarePlan> firmware{};
  std::string on_sync_loss{};  ///< what such a device does; empty: not known
  std::vector<AxisPlan> axes{};
};

/// What the master does when the SYNC that another device makes stays away, beyond telling it.
enum class SyncLoss : std::uint8_t {
  hold,      ///< no outputs are sent: the devices keep what they have
  fallback,  ///< commanded outputs take their fallback, as when their commands grow old
  stop,      ///< NMT stop to every node but the producer; started again when SYNC is back
};

/// How what the devices watch of the master is disarmed at the end of a confirmed ordered stop.
enum class StopDisarm : std::uint8_t {
  sdo,                  ///< 0x1016, 0x1006, 0x100C and 0x100D are written 0
  reset_communication,  ///< NMT reset communication is the last command
};

/// SYNC and the times of a cycle, all counted from SYNC.
struct CyclePlan {
  Time period{};                          ///< of SYNC; without SYNC the image's own period
  bool sync = true;                       ///< false: there is no SYNC
  bool sync_followed = false;             ///< another device makes it
  std::optional<NodeId> sync_producer{};  ///< that device, where the network file has it
  Time sync_timeout{};                    ///< silence after which a followed SYNC is lost
  SyncLoss on_sync_loss = SyncLoss::fallback;
  CobId sync_cob_id = CobId::base(0x080);
  std::uint8_t sync_overflow = 0;  ///< 0x1019; 0 = SYNC without counter
  Time receive_window{};           ///< after this an expected PDO counts as missing
  Time output_deadline{};          ///< outputs start onto the wire at this time
  Time quiet_before_sync{};  ///< nothing of the master's is on the wire for so long before SYNC
  Time sync_window{};        ///< 0x1007 of the devices, 0 = none
  std::uint16_t service_frames = 4;  ///< SDO and NMT frames a cycle at most

  /// Another device's SYNC may come so much early, and the same late, at each of its periods.
  Time followed_tolerance() const noexcept { return period / 20; }

  bool makes_sync() const noexcept { return sync && !sync_followed; }
};

/// The master as producer of TIME. CiA 301, 7.2.6.
struct TimePlan {
  Time period{};  ///< 0: none is sent
  CobId cob_id = CobId::base(0x100);
};

/// Everything the master needs to know of a bus; compiled, printable, constant while it runs.
struct BusPlan {
  std::string name;                   ///< "lift"; LCM channels use it in capitals
  std::string interface{};            ///< "can0"; empty: simulated
  std::uint32_t bitrate = 1'000'000;  ///< bit/s
  NodeId master_id = NodeId::from(127).value();
  Time master_heartbeat{};  ///< producer time of the master, 0 = none
  bool start_nodes = true;  ///< the master sends NMT start after boot
  StartUpPlan start_up{};
  std::vector<std::string> groups{};  ///< names
  CyclePlan cycle{};
  TimePlan time{};
  ImageLayout layout{};
  PdoTable pdos{};
  LimitsPlan limits{};
  std::vector<NodePlan> nodes{};                ///< ascending node id
  Time stop_timeout = std::chrono::seconds{5};  ///< of the whole ordered stop
  StopDisarm stop_disarm = StopDisarm::sdo;

  /// Place in `nodes`; nodes.size(): no node of this id is planned.
  std::size_t index_of(unsigned id) const noexcept {
    const auto found =
        std::ranges::find(nodes, id, [](const NodePlan& node) { return node.id.value(); });
    return static_cast<std::size_t>(found - nodes.begin());
  }
  /// Null: no node of this id is planned.
  const NodePlan* find(unsigned id) const noexcept {
    const std::size_t index = index_of(id);
    return index == nodes.size() ? nullptr : &nodes[index];
  }
};

}  // namespace takt
