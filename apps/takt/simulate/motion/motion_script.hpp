#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <takt/motion.hpp>
#include <vector>

#include "eds_parser/report/source.hpp"
#include "eds_parser/values/time.hpp"

namespace takt {

/// The action of a simulated program for an entry of `motions:`. All but `kill` are calls of Axes.
enum class MotionKind : std::uint8_t {
  enable,
  reset,
  move,
  move_by,
  jog,
  gear,
  stream,
  stop,
  home,
  disable,
  kill,  ///< the program ends without a message; a new one executes the entries that follow
};
inline constexpr std::array<std::string_view, 11> motion_kind_names{
    "enable", "reset", "move", "move_by", "jog", "gear",
    "stream", "stop",  "home", "disable", "kill"};

constexpr std::string_view name(MotionKind kind) noexcept {
  return motion_kind_names[static_cast<std::size_t>(kind)];
}
/// Returns true if the program goes on to its next entry while the axes still move.
constexpr bool goes_on(MotionKind kind) noexcept {
  return kind >= MotionKind::move && kind <= MotionKind::stream;
}
/// Returns true for motions that do not come to rest by themselves.
constexpr bool is_endless(MotionKind kind) noexcept {
  return kind == MotionKind::jog || kind == MotionKind::gear;
}

/// Returns true for the calls that a speed axis refuses.
constexpr bool needs_position(MotionKind kind) noexcept {
  return (goes_on(kind) && kind != MotionKind::jog) || kind == MotionKind::home;
}

/// The ends of an entry that a file can expect: `ended` if its own script ends it, or a word of
/// MotionOutcome::result.
inline constexpr std::array<std::string_view, 9> expectable_ends{
    "done",   "ended",     "refused",   "stopped",  "blocked",
    "no_bus", "time_over", "restarted", "wrong_use"};

/// One entry of `motions:`.
struct MotionEntry {
  MotionKind kind = MotionKind::enable;
  SourcePos pos{};
  /// The time at which the program begins the entry. Empty: as soon as the entry before has ended.
  std::optional<Time> at{};
  /// One of expectable_ends. Empty: `ended` for an endless motion, `done` for the others.
  std::string expect{};
  Eigen::VectorXd values{};  ///< targets of a move, distances of a move_by, velocities of a jog
  MotionBounds bounds{};
  Gear gear{};
  std::vector<PathPoint> points{};
};

/// The actions of a simulated program. The program commands its axes by the entries, in their
/// order.
struct MotionScript {
  std::string program;
  std::vector<std::string> axes;  ///< names as in AxesOptions::names
  std::vector<MotionEntry> entries{};
};
using MotionScripts = std::vector<MotionScript>;

/// Returns true if one of the programs commands an axis of this node.
bool commands_node(const MotionScripts& scripts, std::string_view node);

}  // namespace takt
