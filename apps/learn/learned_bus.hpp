#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "apps/learn/period_meter.hpp"
#include "apps/learn/sdo_observer.hpp"
#include "eds_parser/source.hpp"
#include "eds_parser/table/ids.hpp"

namespace takt {

/// A write of the master, in the order of the recording.
struct LearnedWrite {
  SdoTransfer transfer;
  std::uint32_t line = 0;  ///< of its last frame
};

/// What an object held.
struct LearnedValue {
  std::vector<std::uint8_t> first;  ///< as it was first seen
  std::vector<std::uint8_t> last;
  bool read = false;
  bool written = false;  ///< and the device took it

  std::optional<std::uint64_t> number() const noexcept;
};

using LearnedValues = std::map<ObjectKey, LearnedValue>;

/// From one reset or boot-up message to the next.
struct LearnedBoot {
  std::vector<LearnedWrite> writes;  ///< that the device took, before it was started
  LearnedValues values;
  bool started = false;
};

struct LearnedNode {
  std::uint8_t id = 0;  ///< 1..127
  std::uint32_t first_line = 0;
  bool booted_up = false;
  bool deaf_to_reset = false;  ///< no boot-up message since the newest reset of all nodes
  bool reset_node = false;     ///< newest reset was by NMT reset node, else communication
  bool started = false;        ///< by an NMT command of its own
  bool addressed = false;      ///< any NMT command of its own
  std::uint64_t answers = 0;   ///< SDO frames of the device
  std::uint64_t requests = 0;  ///< SDO frames to it
  PeriodMeter heartbeats;
  PeriodMeter guard_requests;
  std::vector<LearnedBoot> boots;
  std::vector<LearnedWrite> refused;
  std::vector<LearnedWrite> later;  ///< writes while OPERATIONAL: of an application
  SdoObserver sdo;

  bool guarded() const noexcept { return guard_requests.count() > 2; }
  /// It has SDO answers, boot-up messages or heartbeats, or the master counts on it: more than
  /// reads that nobody answered.
  bool is_there() const noexcept;
  /// The writes of the fullest boot, with those that only other boots have.
  std::vector<LearnedWrite> configuration() const;
  /// What objects held at the end of it.
  LearnedValues values() const;
};

/// Frames of one identifier that no service claims.
struct LearnedTraffic {
  PeriodMeter frames;
  PeriodMeter requests;  ///< remote ones
  std::uint8_t shortest = 8;
  std::uint8_t longest = 0;
  std::uint32_t first_line = 0;
};

struct LearnedSync {
  PeriodMeter frames;
  std::uint8_t highest_counter = 0;  ///< 0: frames without counter
};

/// All that a recording says of a bus, before any device file is known.
struct LearnedBus {
  std::string file;
  std::string interface;
  std::uint64_t frames = 0;
  std::uint64_t error_frames = 0;
  std::optional<double> seconds;
  std::map<CobId, LearnedTraffic> traffic;  ///< SYNC, PDOs and what is unknown
  std::uint64_t more_traffic = 0;           ///< frames of still more identifiers
  PeriodMeter time;                         ///< 0x100
  std::uint64_t lss = 0;                    ///< frames of 0x7E4 and 0x7E5
  bool started_all = false;                 ///< NMT start by broadcast
  std::map<std::uint8_t, LearnedNode> nodes;
  std::map<std::uint32_t, LearnedSync> sync;  ///< by identifier; only those that may be SYNC
  Findings findings;

  /// The node id of the master that made the recording; none: nothing says so.
  std::optional<std::uint8_t> master() const;
  /// Nodes but for the master and those that `strangers` has.
  std::vector<const LearnedNode*> devices() const;
  /// Ids that were asked by SDO and never heard, as by a scan.
  std::vector<std::uint8_t> strangers() const;

 private:
  bool is_there(const LearnedNode& node) const;
  /// It sends an EMCY, or a TPDO by the predefined set that is no other node's.
  bool sends_as_device(std::uint8_t node_id) const;
};

}  // namespace takt
