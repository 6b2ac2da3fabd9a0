#pragma once
#include <cstdint>
#include <functional>
#include <takt/command_t.hpp>
#include <takt/image_t.hpp>
#include <takt/motion_command_t.hpp>
#include <takt/motion_gear_t.hpp>
#include <takt/motion_stream_t.hpp>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"
#include "master/gateway/front_round.hpp"

namespace takt::soak {

/// Cycles from the view of the front thread.
struct SeenCycles {
  std::int64_t newest = 0;  ///< cycle of the newest image that the front thread has received
  std::int64_t now = 0;     ///< present cycle by the clock, which may be newer
};

/// Hooks with which a test breaks a run of the front thread, to check that the judges find the
/// defect. Empty functions break nothing.
struct FrontDefect {
  /// Replaces functions of the round of the front thread.
  std::function<void(FrontRound& round)> round{};
  /// Changes the plan of the daemon; the judges use the correct plan.
  std::function<void(BusPlan& plan)> plan{};
  /// Changes a command before the daemon judges it.
  std::function<void(command_t& command, const SeenCycles& cycles)> command{};
  /// Returns the messages about motions that the daemon receives instead of this one.
  std::function<std::vector<motion_command_t>(motion_command_t command, const SeenCycles& cycles)>
      motion{};
  /// Changes a gear before the daemon judges it.
  std::function<void(motion_gear_t& gear)> gear{};
  /// Changes a message about a stream before the daemon judges it.
  std::function<void(motion_stream_t& stream)> stream{};
  /// Returns the instance that a program uses. `own` is the random instance of the program.
  std::function<std::int64_t(unsigned program, std::int64_t own)> instance{};
  /// Returns false if the program shall ignore this image.
  std::function<bool(unsigned program, const image_t& image)> hears{};
};

}  // namespace takt::soak
