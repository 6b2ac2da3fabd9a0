#pragma once
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "eds_parser/table/mechanics.hpp"

namespace takt::sim {

/// A part of the way of an axis, between two samples of its sensors.
struct Stretch {
  double from = 0;
  double to = 0;

  bool forward() const noexcept { return to > from; }
  /// Returns the part of the stretch (0 .. 1) after which it crosses `at`, if it does.
  std::optional<double> crosses(double at) const noexcept {
    if ((from < at) == (to < at)) return std::nullopt;
    return (at - from) / (to - from);
  }
};

enum class EdgeKind : std::uint8_t { none, rising, falling };

/// A change of a switch within a stretch.
struct SwitchEdge {
  EdgeKind kind = EdgeKind::none;
  double part = 0;  ///< part of the stretch, 0 .. 1
};

/// A switch that is active where the axis is in a zone (low <= position < high). A zone without low
/// or high end is given with an infinite one.
class ZoneSwitch {
 public:
  explicit ZoneSwitch(const ZoneParameters& zone) noexcept : zone_{zone} {}

  double low() const noexcept { return zone_.low; }
  double high() const noexcept { return zone_.high; }
  bool active(double position) const noexcept {
    return position >= zone_.low && position < zone_.high;
  }
  /// Returns the last edge within the stretch. A zone that the stretch passes as a whole gives its
  /// falling edge.
  SwitchEdge edge(const Stretch& way) const noexcept {
    const auto low = way.crosses(zone_.low);
    const auto high = way.crosses(zone_.high);
    const auto in = way.forward() ? low : high;
    const auto out = way.forward() ? high : low;
    if (out) return {EdgeKind::falling, *out};
    return in ? SwitchEdge{EdgeKind::rising, *in} : SwitchEdge{};
  }

 private:
  ZoneParameters zone_;
};

/// The index pulse of an encoder: once in each turn of the motor.
class IndexPulse {
 public:
  /// `offset` is the position of one pulse.
  IndexPulse(double turn, double offset) noexcept
      : turn_{turn}, offset_{offset}, turns_{turns_at(0)} {}

  /// Moves to a position, the first time from position 0. Returns the position of the first pulse
  /// that is crossed.
  std::optional<double> move_to(double position) noexcept {
    const double before = std::exchange(turns_, turns_at(position));
    if (before == turns_) return std::nullopt;
    return offset_ + turn_ * (before < turns_ ? before + 1 : before);
  }

 private:
  double turns_at(double position) const noexcept {
    return std::floor((position - offset_) / turn_);
  }

  double turn_;
  double offset_;
  double turns_;  ///< whole turns from `offset_` to the present position
};

}  // namespace takt::sim
