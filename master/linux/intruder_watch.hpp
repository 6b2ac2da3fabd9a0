#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"
#include "master/core/event.hpp"
#include "master/linux/sent_frames.hpp"
#include "master/wire/frame.hpp"

namespace takt {

/// Who has put a frame onto the wire, as far as the kernel knows.
enum class Origin : std::uint8_t {
  wire,          ///< another device, for certain
  this_machine,  ///< our bus thread or another program here: only counting tells them apart
};

/// Finds those who should not be on the bus: another SYNC, another NMT master, two senders of one
/// COB-ID. Pure: frames, times and counts in, events out. Front thread.
///
/// * An identifier of the master's (SYNC, NMT, RPDOs, its heartbeat): a frame of it from the wire,
/// or
///   more frames of it than the bus thread has sent.
/// * A cyclic TPDO: one and a half times as many frames as its transmission type allows over 32
/// SYNCs.
/// * An SDO server: answers that nobody has asked for, three times (two nodes of one id both
/// answer).
class IntruderWatch {
 public:
  explicit IntruderWatch(const BusPlan& plan);

  void on_frame(const StampedFrame& frame, Origin origin);
  /// All frames that were waiting have been given; compares with what the bus thread has sent.
  void on_drained(const SentFrames& sent, Time now);
  bool take(Event& event);

 private:
  struct Own {  // one identifier of the master's
    CobId id;
    EventKind kind = EventKind::duplicate_cob_id;
    std::uint32_t seen = 0;          // on this machine's side, in step with SentFrames
    std::uint32_t least_behind = 0;  // of sent - seen since the last adjustment
    Frame last;
  };
  struct Cyclic {  // one cyclic TPDO
    CobId id;
    std::uint8_t node = 0;
    std::uint8_t every = 1;  // SYNCs
    std::uint32_t seen = 0;
  };
  struct SdoServer {
    std::uint8_t asked = 0;  // requests whose answer may still come, however late
    bool block = false;      // block transfer: several answers to one request
    std::uint8_t unasked = 0;
  };

  void watch_own(Own& own, const StampedFrame& frame, Origin origin);
  void watch_sync_interval(Time now);
  void watch_sdo(const StampedFrame& frame);
  void tell(EventKind kind, CobId id, std::uint8_t node, const Frame& frame, Time now);

  CobId sync_id_;
  std::vector<Own> own_;
  std::vector<Cyclic> cyclic_;
  std::array<std::uint16_t, 2048> own_index_;
  std::array<std::uint16_t, 2048> cyclic_index_;
  std::array<SdoServer, 128> servers_{};
  std::array<Time, 2048> told_{};
  std::uint32_t syncs_ = 0;
  Time adjusted_{};
  bool started_ = false;
  std::vector<Event> events_;
};

}  // namespace takt
