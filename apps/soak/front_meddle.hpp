#pragma once
#include <cstdint>
#include <functional>
#include <takt/image_t.hpp>

#include "eds_parser/table/bus_plan.hpp"
#include "master/gateway/front_round.hpp"

namespace takt {

/// Hooks with which a test breaks a run of the front thread, to see whether the judges find it.
/// Empty functions break nothing.
struct FrontMeddle {
  /// Returns the time that the front thread reads from its clock. `newest` is the SYNC time of the
  /// newest image that it has seen.
  std::function<Time(Time now, Time newest)> clock{};
  /// Replaces steps of the round.
  std::function<void(FrontRound& round)> round{};
  /// Changes the plan of the daemon; the judges keep the real one.
  std::function<void(BusPlan& plan)> plan{};
  /// Returns the instance that a program uses. `own` is its random one.
  std::function<std::int64_t(unsigned program, std::int64_t own)> instance{};
  /// Returns false if the program shall ignore this image.
  std::function<bool(unsigned program, const image_t& image)> hears{};
};

}  // namespace takt
