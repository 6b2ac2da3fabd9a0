#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"
#include "master/core/event.hpp"
#include "master/linux/sent_frames.hpp"
#include "master/wire/frame.hpp"

namespace takt {

/// Origin of a frame, as far as the kernel knows it.
enum class Origin : std::uint8_t {
  wire,  ///< another device, for certain
  /// The bus thread or another program on this machine; only the counts of frames distinguish them.
  this_machine,
};

/// Detects participants that should not be on the bus: another producer of SYNC, another NMT
/// master, two senders of one COB-ID. The class takes frames, times and counts, gives events, and
/// makes no system calls. All calls come from the front thread.
///
/// * COB-IDs of the master (SYNC, NMT, RPDOs, its heartbeat): another device has sent such a frame,
///   or this machine has sent more of these frames than the bus thread.
/// * Cyclic TPDOs: within 32 SYNCs, more than one and a half times as many frames arrive as the
///   transmission type allows.
/// * SDO servers: three answers arrive that nobody has requested, because two nodes with the same
///   node-ID both answer.
class IntruderWatch {
 public:
  explicit IntruderWatch(const BusPlan& plan);

  void on_frame(const StampedFrame& frame, Origin origin);
  /// Call this when all waiting frames were given. Compares their counts with what the bus thread
  /// has sent.
  void on_drained(const SentFrames& sent, Time now);
  bool take(Event& event);

 private:
  struct Own {  // one COB-ID of the master
    CobId id;
    EventKind kind = EventKind::duplicate_cob_id;
    std::uint32_t seen = 0;          // frames seen from this machine, comparable with SentFrames
    std::uint32_t least_behind = 0;  // minimum of sent - seen since the last adjustment
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
    bool block = false;      // a block transfer runs: one request has several answers
    std::uint8_t unasked = 0;
  };

  void watch_own(Own& own, const StampedFrame& frame, Origin origin);
  void watch_sync_interval(Time now);
  void watch_sdo(const StampedFrame& frame);
  void announce(EventKind kind, CobId id, std::uint8_t node, const Frame& frame, Time now);

  CobId sync_id_;
  std::vector<Own> own_;
  std::vector<Cyclic> cyclic_;
  std::array<std::uint16_t, 2048> own_index_;
  std::array<std::uint16_t, 2048> cyclic_index_;
  std::array<SdoServer, 128> servers_{};
  std::array<Time, 2048> reported_{};
  std::uint32_t syncs_ = 0;
  Time adjusted_{};
  bool started_ = false;
  std::vector<Event> events_;
};

}  // namespace takt
