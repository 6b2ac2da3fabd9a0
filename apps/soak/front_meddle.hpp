#pragma once
#include <cstdint>
#include <functional>
#include <takt/image_t.hpp>

#include "eds_parser/table/bus_plan.hpp"
#include "master/gateway/front_round.hpp"

namespace takt {

/// What a test breaks in a run of the front thread, to see whether the judges tell. Empty functions
/// break nothing.
struct FrontMeddle {
  /// What the front thread reads as time. `newest` is the SYNC of the newest image that it has
  /// seen.
  std::function<Time(Time now, Time newest)> clock{};
  /// Replaces steps of the round.
  std::function<void(FrontRound& round)> round{};
  /// Alters the plan of the daemon; the judges keep the real one.
  std::function<void(BusPlan& plan)> plan{};
  /// Which instance a program gives itself, `own` being its random one.
  std::function<std::int64_t(unsigned program, std::int64_t own)> instance{};
  /// False: the programs do not look at this image.
  std::function<bool(unsigned program, const image_t& image)> hears{};
};

}  // namespace takt
