#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "eds_parser/table/boot_plan.hpp"
#include "eds_parser/table/ids.hpp"
#include "eds_parser/table/image_layout.hpp"
#include "eds_parser/table/pdo_table.hpp"
#include "eds_parser/table/time.hpp"

namespace takt {

/// An error code of one device family in words.
struct EmcyText {
  std::uint16_t code = 0;
  std::string text;
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
  Time heartbeat_timeout{};                 ///< longest silence; 0 = not watched
  Time sdo_timeout{};                       ///< of requests while running
  Time reboot_delay{};                      ///< pause before a failed boot is tried again
  std::string device_data{};                ///< entry that was applied: "Lenze 8400 HighLine"
  std::string device_data_file{};           ///< "lenze8400.yaml"
  std::vector<std::string> device_notes{};  ///< what it says, a line each
  std::vector<EmcyText> emcy_texts{};       ///< of this device family
};

/// SYNC and the times of a cycle, all counted from SYNC.
struct CyclePlan {
  Time period{};     ///< of SYNC; without SYNC the image's own period
  bool sync = true;  ///< false: no SYNC is sent
  CobId sync_cob_id = CobId::base(0x080);
  std::uint8_t sync_overflow = 0;  ///< 0x1019; 0 = SYNC without counter
  Time receive_window{};           ///< after this an expected PDO counts as missing
  Time output_deadline{};          ///< outputs start onto the wire at this time
  Time quiet_before_sync{};  ///< nothing of the master's is on the wire for so long before SYNC
  Time sync_window{};        ///< 0x1007 of the devices, 0 = none
  std::uint16_t service_frames = 4;  ///< SDO and NMT frames a cycle at most
};

/// Everything the master needs to know of a bus; compiled, printable, constant while it runs.
struct BusPlan {
  std::string name;                   ///< "lift"; LCM channels use it in capitals
  std::string interface{};            ///< "can0"; empty: simulated
  std::uint32_t bitrate = 1'000'000;  ///< bit/s
  NodeId master_id = NodeId::from(127).value();
  Time master_heartbeat{};  ///< producer time of the master, 0 = none
  bool start_nodes = true;  ///< the master sends NMT start after boot
  CyclePlan cycle{};
  ImageLayout layout{};
  PdoTable pdos{};
  std::vector<NodePlan> nodes{};                ///< ascending node id
  Time stop_timeout = std::chrono::seconds{5};  ///< of the whole ordered stop
};

}  // namespace takt
