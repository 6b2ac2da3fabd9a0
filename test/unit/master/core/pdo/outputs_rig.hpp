#pragma once
#include <chrono>
#include <initializer_list>
#include <utility>
#include <vector>

#include "master/core/pdo/pdo_exchange.hpp"
#include "master/core/pdo/pdo_outputs.hpp"
#include "test/unit/master/core/pdo/small_plan.hpp"

namespace takt {

using namespace std::chrono_literals;

/// The outputs of a plan and the set-points from the front thread.
class OutputsRig {
 public:
  explicit OutputsRig(BusPlan plan) : plan_{std::move(plan)}, pdos{plan_, events} {
    points.resize(plan_.layout.outputs());
    for (std::size_t i = 0; i < plan_.nodes.size(); ++i) {
      pdos.inputs().set_reception(i, Reception::full);
      pdos.outputs().open(i, points);
    }
  }

  void command(std::size_t output, std::int64_t value, std::uint32_t ttl = 0) {
    points[output] = {value, points[output].generation + 1, ttl, now_ + Time{1ms}};
  }
  void feedback(unsigned node, std::initializer_list<std::uint8_t> bytes) {
    pdos.inputs().receive({.frame = make_frame(CobId::base(0x180 + node), bytes), .when = now_});
  }
  std::vector<Frame> pack() {
    ++cycle_;
    now_ = static_cast<std::int64_t>(cycle_) * Time{2ms} + late;
    const OutputMoment moment{.cycle = cycle_, .now = now_};
    const auto frames = pdos.outputs().pack(points, moment);
    const std::vector<Frame> copy{frames.begin(), frames.end()};
    pdos.outputs().sent(accepted, moment);
    return copy;
  }
  void skip(std::uint64_t cycles) { cycle_ += cycles; }
  std::vector<EventKind> reported() {
    std::vector<EventKind> all;
    for (Event event; events.pop(event);) all.push_back(event.kind);
    return all;
  }

 private:
  BusPlan plan_;
  std::uint64_t cycle_ = 0;
  Time now_{};

 public:
  EventQueue events;
  PdoExchange pdos;
  std::vector<SetPoint> points;
  std::size_t accepted = 100;  // number of frames that the interface accepts
  Time late{};                 // delay of a cycle when it packs its outputs
};

}  // namespace takt
