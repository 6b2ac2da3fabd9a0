#pragma once
#include <cmath>
#include <cstdint>
#include <optional>

#include "eds_parser/table/mechanics.hpp"

namespace takt::sim {

/// A piece of the way of an axis between two looks at its sensors.
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
  double part = 0;  ///< of the stretch, 0 .. 1
};

/// A switch that is active where the axis is in a zone (low <= position < high). A zone without low
/// or high end is given with an infinite one.
class ZoneSwitch {
 public:
  explicit ZoneSwitch(const ZoneParameters& zone) noexcept : zone_{zone} {}

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
  IndexPulse(double turn, double offset) noexcept : turn_{turn}, offset_{offset} {}

  /// Returns the position of the first pulse that the stretch crosses.
  std::optional<double> crossed(const Stretch& way) const noexcept {
    const double low = std::floor((way.from - offset_) / turn_);
    const double high = std::floor((way.to - offset_) / turn_);
    if (low == high) return std::nullopt;
    return offset_ + turn_ * (way.forward() ? low + 1 : low);
  }

 private:
  double turn_;
  double offset_;
};

}  // namespace takt::sim
