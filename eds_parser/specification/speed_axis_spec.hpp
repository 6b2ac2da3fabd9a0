#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "eds_parser/report/source.hpp"
#include "eds_parser/table/speed_axis.hpp"
#include "eds_parser/values/ids.hpp"

namespace takt {

/// A speed in an object: speed = raw x scale, in `unit`.
struct SpeedValueSpec {
  ObjectKey object{};
  double scale = 1.0;
  std::string unit{};
};

/// The commands that are stated; the others keep the value of the device data.
struct SpeedCommandsSpec {
  std::optional<std::uint16_t> mask;
  std::optional<std::uint16_t> off;
  std::optional<std::uint16_t> stop;
  std::optional<std::uint16_t> run;
  std::optional<std::uint16_t> run_reverse;
  std::optional<std::uint16_t> quick_stop;
  std::optional<std::uint16_t> reset;
};

/// `speed_axis:` of the device data or of a node. What a node states takes precedence.
struct SpeedAxisSpec {
  SourcePos pos{};  ///< place of the section; empty if there is none
  bool enabled = true;
  std::optional<SpeedSequence> sequence;
  std::optional<FaultReset> fault_reset;
  std::optional<ObjectKey> control;
  std::optional<ObjectKey> status;
  std::optional<SpeedValueSpec> set_speed;
  std::optional<SpeedValueSpec> actual_speed;
  SpeedCommandsSpec commands;
  SpeedStates states;  ///< a pattern without a mask is not stated
  std::string ramps;   ///< text that says where the ramps of the drive are
  std::string source;  ///< text that says where these facts come from

  bool is_stated() const noexcept { return pos != SourcePos{}; }
};

/// Returns the name of the first part that is missing, for example "`control`". The name is empty
/// if the axis has all parts that it needs.
std::string missing_part(const SpeedAxisSpec& axis);
/// Returns `axis`, in which each part that `own` states replaces the same part.
SpeedAxisSpec merged(SpeedAxisSpec axis, const SpeedAxisSpec& own);
/// Returns the objects and the commands of a CiA 402 drive in velocity mode (vl, mode 2). CiA
/// 402-2: 0x6042 and 0x6044 are in revolutions per minute unless 0x604C says something else.
SpeedAxisSpec velocity_mode_axis();

}  // namespace takt
