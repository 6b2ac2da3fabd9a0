#pragma once
#include <array>
#include <atomic>
#include <cstdint>

#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/table/motion_axes.hpp"
#include "master/core/event.hpp"
#include "master/core/request.hpp"
#include "master/motion/beat/motion_message.hpp"
#include "master/rt/exchange/histogram.hpp"
#include "master/rt/exchange/motion_board.hpp"
#include "master/rt/exchange/process_image.hpp"
#include "master/rt/exchange/set_points.hpp"
#include "master/rt/exchange/spsc_ring.hpp"
#include "master/rt/exchange/status_board.hpp"

namespace takt {

/// Timing of the cycle, recorded by the bus thread.
struct TimingHistograms {
  /// Time from the deadline to the moment just before SYNC is handed over. If another device
  /// produces SYNC: how far its arrival is from the deadline, early or late.
  Histogram sync_lateness;
  /// Time from the deadline to the echo of SYNC, if the port has echoes.
  Histogram sync_on_wire;
  Histogram sync_to_last_pdo;  ///< time from SYNC to the arrival of the last expected PDO
  Histogram sync_to_publish;
  Histogram command_age;  ///< time from SetPoints::publish() to the outputs that carry the command
};

/// Number of messages about motions that the bus thread takes in one cycle: an order for each axis,
/// and a few more. Points of streams are accepted only while the ring has room for more than this
/// number of messages, so that the other messages always find room.
inline constexpr std::size_t motions_a_cycle = motion::max_axes + 8;

/// Everything that the bus thread and the front thread share, without a lock between them. The
/// object is large and belongs on the heap.
struct Exchange {
  explicit Exchange(const BusPlan& plan)
      : images{plan.layout.signals.size(), plan.pdos.tpdos.size()},
        status{plan.nodes.size(), plan.pdos.tpdos.size(), plan.pdos.rpdos.size()},
        motion_board{motion_axes(plan).size()},
        set_points{plan.layout.outputs()} {}
  Exchange(const Exchange&) = delete;
  Exchange& operator=(const Exchange&) = delete;

  // From the bus thread to the front thread.
  ImageRing images;
  SpscRing<Reply, 16> replies;
  SpscRing<Event, 1024> events;
  StatusBoard status;
  MotionBoard motion_board;
  SpscRing<motion::MotionEnd, 512> motion_ends;
  TimingHistograms timing;
  /// Expected publish time of the next image (monotonic clock, ns). The front thread sets its own
  /// timer to this time; the bus thread does not wake it.
  std::atomic<std::int64_t> next_publish{0};
  std::atomic<bool> finished{false};  ///< true once the ordered stop is complete

  // From the front thread to the bus thread.
  SetPoints set_points;
  SpscRing<Request, 16> requests;
  SpscRing<motion::MotionMessage, 256> motions;
  std::array<SdoTransfer, 4> transfers;  ///< SdoTransfer names the thread that may use each
  std::atomic<bool> stop_requested{false};
};

}  // namespace takt
