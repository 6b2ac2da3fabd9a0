#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "apps/takt/learn/period_meter.hpp"
#include "eds_parser/report/source.hpp"
#include "eds_parser/values/ids.hpp"
#include "master/trace/sdo_follower.hpp"

namespace takt::learn {

/// An SDO write of the master.
struct LearnedWrite {
  SeenTransfer transfer;
  std::uint32_t line = 0;  ///< line of its last frame in the recording
};

/// Values of an object in the recording.
struct LearnedValue {
  std::vector<std::uint8_t> first;  ///< first value that was seen
  std::vector<std::uint8_t> last;   ///< last value that was seen
  bool read = false;
  bool written = false;  ///< true if the device has accepted a write

  /// Returns the last value as a number, or std::nullopt if it does not have 1 to 8 bytes.
  std::optional<std::uint64_t> number() const noexcept;
};

/// Values of the objects of a device.
struct LearnedValues : std::map<ObjectKey, LearnedValue> {
  /// Returns the last value of an object as a number, or std::nullopt if it is no number or not
  /// known.
  std::optional<std::uint64_t> number(ObjectKey key) const noexcept;
  /// Returns number() of an object that the master has read, else std::nullopt.
  std::optional<std::uint64_t> number_read(ObjectKey key) const noexcept;
  /// Returns number() of an object that the master has written, else std::nullopt.
  std::optional<std::uint64_t> number_written(ObjectKey key) const noexcept;
};

/// Transfers from one reset or boot-up message to the next.
struct LearnedBoot {
  std::vector<LearnedWrite> writes;  ///< writes that the device accepted before its NMT start
  LearnedValues values;
  bool started = false;
};

/// One node of the recording.
struct LearnedNode {
  std::uint8_t id = 0;  ///< node-ID, 1..127
  std::uint32_t first_line = 0;
  bool booted_up = false;
  bool ignores_reset = false;  ///< no boot-up message since the newest reset of all nodes
  bool reset_node = false;     ///< true: newest reset by NMT reset node; false: reset communication
  bool started = false;        ///< true after an NMT start for this node alone
  bool addressed = false;      ///< true after any NMT command for this node alone
  std::uint64_t answers = 0;   ///< number of SDO frames from the device
  std::uint64_t requests = 0;  ///< number of SDO frames to the device
  PeriodMeter heartbeats;
  PeriodMeter guard_requests;
  std::vector<LearnedBoot> boots;
  std::vector<LearnedWrite> refused;
  std::vector<LearnedWrite> later;  ///< writes while OPERATIONAL, which come from an application
  SdoFollower sdo;

  bool guarded() const noexcept { return guard_requests.count() > 2; }
  /// Returns true if the node exists: it sends SDO answers, boot-up messages or heartbeats, or the
  /// master sends it NMT commands or guarding requests. SDO requests without an answer do not
  /// suffice.
  bool is_there() const noexcept;
  /// Returns the writes of the boot with the most writes, and then the writes that only other boots
  /// have.
  std::vector<LearnedWrite> configuration() const;
  /// Returns the values of the objects at the end of the boot with the most writes, and then the
  /// values of objects that only other boots have.
  LearnedValues values() const;
};

/// Frames with one identifier that belongs to no known service.
struct LearnedTraffic {
  PeriodMeter frames;
  PeriodMeter requests;       ///< remote frames
  std::uint8_t shortest = 8;  ///< bytes
  std::uint8_t longest = 0;   ///< bytes
  std::uint32_t first_line = 0;
};

/// Frames with one identifier that may be SYNC.
struct LearnedSync {
  PeriodMeter frames;
  std::uint8_t highest_counter = 0;  ///< 0 means frames without a counter
};

/// Everything that a recording shows of a bus, before any device file is known.
struct LearnedBus {
  std::string file;
  std::string interface;
  std::uint64_t frames = 0;
  std::uint64_t error_frames = 0;
  std::optional<double> seconds;
  std::map<CobId, LearnedTraffic> traffic;  ///< SYNC, EMCY, PDOs and unknown frames
  std::uint64_t more_traffic = 0;           ///< frames that the full list `traffic` could not take
  PeriodMeter time;                         ///< TIME, 0x100
  std::uint64_t lss = 0;                    ///< frames with the identifiers 0x7E4 and 0x7E5
  bool started_all = false;                 ///< true after an NMT start by broadcast
  std::map<std::uint8_t, LearnedNode> nodes;
  /// Frames that may be SYNC, by their identifiers.
  std::map<std::uint32_t, LearnedSync> sync;
  Findings findings;

  /// Returns the node-ID of the master in the recording, or std::nullopt if nothing shows it.
  std::optional<std::uint8_t> master() const;
  /// Returns all nodes except the master and those in strangers().
  std::vector<const LearnedNode*> devices() const;
  /// Returns the node-IDs that got SDO requests but sent no frame, for example in a scan.
  std::vector<std::uint8_t> strangers() const;

 private:
  bool is_there(const LearnedNode& node) const;
  /// Returns true if the node sends an EMCY, or a TPDO of the predefined connection set that is not
  /// the TPDO of another node.
  bool sends_as_device(std::uint8_t node_id) const;
};

}  // namespace takt::learn
