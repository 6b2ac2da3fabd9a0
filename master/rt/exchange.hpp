#pragma once
#include <array>
#include <atomic>
#include <cstdint>

#include "eds_parser/table/bus_plan.hpp"
#include "master/core/event.hpp"
#include "master/core/request.hpp"
#include "master/rt/histogram.hpp"
#include "master/rt/process_image.hpp"
#include "master/rt/set_points.hpp"
#include "master/rt/spsc_ring.hpp"
#include "master/rt/status_board.hpp"

namespace takt {

/// Times of the cycle, recorded by the bus thread.
struct TimingHistograms {
  Histogram sync_lateness;     ///< SYNC handed over, against its deadline
  Histogram sync_on_wire;      ///< the same by the echo, where the port has one
  Histogram sync_to_last_pdo;  ///< arrival of the last expected PDO
  Histogram sync_to_publish;
  Histogram command_age;  ///< from SetPoints::publish() to the outputs that carry it
};

/// Everything that the bus thread and the front thread share; no lock between them. Large: lives
/// on the heap.
struct Exchange {
  explicit Exchange(const BusPlan& plan)
      : images{plan.layout.signals.size(), plan.pdos.tpdos.size()},
        status{plan.nodes.size(), plan.pdos.tpdos.size(), plan.pdos.rpdos.size()},
        set_points{plan.layout.outputs()} {}
  Exchange(const Exchange&) = delete;
  Exchange& operator=(const Exchange&) = delete;

  // bus -> front
  ImageRing images;
  SpscRing<Reply, 16> replies;
  SpscRing<Event, 1024> events;
  StatusBoard status;
  TimingHistograms timing;
  /// When the next image will be there (monotonic, ns): the front thread sleeps to it by itself.
  std::atomic<std::int64_t> next_publish{0};
  std::atomic<bool> finished{false};  ///< the ordered stop is over

  // front -> bus
  SetPoints set_points;
  SpscRing<Request, 16> requests;
  std::array<SdoTransfer, 4> transfers;  ///< whose turn it is: see SdoTransfer
  std::atomic<bool> stop_requested{false};
};

}  // namespace takt
