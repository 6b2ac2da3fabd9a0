#include "apps/takt/smooth/make_record.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <tuple>

#include "apps/takt/smooth/judge/numbers.hpp"
#include "apps/takt/smooth/judge/signals.hpp"
#include "apps/takt/smooth/judge/wire_load.hpp"
#include "eds_parser/values/little_endian.hpp"

namespace takt::smooth {
namespace {

constexpr std::array set_point_objects{ObjectKey{0x607A, 0}, ObjectKey{0x60C1, 1},
                                       ObjectKey{0x60FF, 0}};

std::optional<std::uint64_t> value_of(const MapNode& node, ObjectKey key) {
  const auto found = node.values.find(key);
  return found == node.values.end() ? std::nullopt : std::optional{found->second};
}

/// Returns 0x60C2 of an axis as a time: value x 10^exponent seconds.
std::optional<Time> interpolation_of(const MapNode& node, unsigned axis) {
  const auto value = value_of(node, axis_object(axis, 0x60C2, 1));
  if (!value || *value == 0) return {};
  const auto exponent =
      static_cast<std::int8_t>(value_of(node, axis_object(axis, 0x60C2, 2)).value_or(0xFD));
  if (exponent < -9 || exponent > 0) return {};
  const double s = static_cast<double>(*value & 0xFFU) * std::pow(10.0, exponent);
  return Time{std::llround(s * 1e9)};
}

AxisSettings settings_of(const PdoMap& map, const MapPdo& pdo, unsigned axis) {
  AxisSettings out{.transmission = pdo.transmission};
  for (const auto& [id, other] : map.pdos) {
    if (other.node != pdo.node || !other.is_rpdo) continue;
    out.feed_forward = out.feed_forward || std::ranges::any_of(other.fields, [&](MapField field) {
                         return field.object == axis_object(axis, 0x60B1) ||
                                field.object == axis_object(axis, 0x60B2);
                       });
  }
  const auto known = map.nodes.find(pdo.node);
  if (known == map.nodes.end()) return out;
  const MapNode& node = known->second;
  out.interpolation = interpolation_of(node, axis);
  out.boot_seen = node.boot_seen;
  out.interpolation_refused = std::ranges::any_of(
      node.refused, [&](ObjectKey key) { return key.index == axis_object(axis, 0x60C2).index; });
  if (const auto mode = value_of(node, axis_object(axis, 0x6060))) {
    out.mode = static_cast<std::int8_t>(*mode);
  }
  return out;
}

std::string name_of(const PdoMap& map, const MapPdo& pdo, unsigned axis) {
  const auto known = map.nodes.find(pdo.node);
  const bool named = known != map.nodes.end() && !known->second.name.empty();
  std::string name = named ? known->second.name : fmt::format("node {}", pdo.node);
  if (axis != 0) name += fmt::format(" axis {}", axis + 1);
  return name;
}

/// Returns true if a set-point is used in this mode.
bool is_used_in(const AxisRecord& axis, std::int64_t mode) {
  const unsigned role = axis.set_point.index - axis.axis * 0x800U;
  if (role == 0x60FF) return mode == 9;
  return role == 0x60C1 ? mode == 7 : mode == 8 || mode == 7;
}

/// Returns the number of samples in which the axis was in a mode that uses this set-point.
std::size_t use_of(const AxisRecord& axis) {
  const auto& modes = axis.modes.empty() ? axis.asked_modes : axis.modes;
  const auto used = [&](const Sample& sample) { return is_used_in(axis, sample.value); };
  const auto seen = static_cast<std::size_t>(std::ranges::count_if(modes, used));
  return seen != 0 ? seen : axis.settings.mode && is_used_in(axis, *axis.settings.mode) ? 1 : 0;
}

/// One signal of one axis in the frames of a PDO.
struct Route {
  std::size_t axis = 0;
  MapField field{};
  bool is_rpdo = false;
};

std::int64_t raw_value(const Frame& frame, MapField field, bool is_signed) {
  const std::uint64_t word = from_little_endian(std::as_bytes(std::span{frame.data}));
  const std::uint64_t mask =
      field.bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << field.bits) - 1;
  const std::uint64_t value = word >> field.offset & mask;
  const bool negative = is_signed && (value >> (field.bits - 1) & 1U) != 0;
  return static_cast<std::int64_t>(negative ? value | ~mask : value);
}

bool is_word_of_bits(const AxisRecord& axis, ObjectKey object) {
  const unsigned role = object.index - axis.axis * 0x800U;
  return role == 0x6040 || role == 0x6041;
}

class RecordMaker {
 public:
  RecordMaker(const Trace& trace, const PdoMap& map) : trace_{trace}, map_{map} {
    out_.axes = axes_of(map);
    for (const auto& [id, pdo] : map.pdos) {
      for (const MapField& field : pdo.fields) add_routes(pdo, field);
    }
  }

  BusRecord make() {
    out_.source = trace_.bus.file;
    out_.resolution = trace_.resolution;
    out_.planned_period = map_.sync_period;
    for (const StampedFrame& frame : trace_.frames) take(frame);
    if (!out_.frames.empty()) out_.length = out_.frames.back().when;
    out_.bitrate = map_.bitrate != 0 ? map_.bitrate : guessed_bitrate(out_.frames);
    keep_used_set_points(out_.axes);
    return std::move(out_);
  }

 private:
  void add_routes(const MapPdo& pdo, const MapField& field) {
    if (field.bits == 0 || field.bits > 64) return;
    for (std::size_t i = 0; i < out_.axes.size(); ++i) {
      if (out_.axes[i].node != pdo.node) continue;
      if (samples_of(out_.axes[i], field.object, pdo.is_rpdo) == nullptr) continue;
      routes_[pdo.id].push_back({i, field, pdo.is_rpdo});
    }
  }

  void take(const StampedFrame& stamped) {
    const Frame& frame = stamped.frame;
    out_.frames.push_back({stamped.when, wire_bits(frame)});
    if (frame.rtr) return;
    if (frame.id == map_.sync_id) out_.syncs.push_back(stamped.when);
    const auto found = routes_.find(frame.id);
    if (found == routes_.end()) return;
    for (const Route& route : found->second) {
      if (route.field.offset + route.field.bits > 8U * frame.length) continue;
      AxisRecord& axis = out_.axes[route.axis];
      const bool is_signed = !is_word_of_bits(axis, route.field.object);
      samples_of(axis, route.field.object, route.is_rpdo)
          ->push_back({stamped.when, raw_value(frame, route.field, is_signed)});
    }
  }

  const Trace& trace_;
  const PdoMap& map_;
  BusRecord out_;
  std::map<CobId, std::vector<Route>> routes_;
};

}  // namespace

std::vector<AxisRecord> axes_of(const PdoMap& map) {
  std::vector<AxisRecord> axes;
  for (const auto& [id, pdo] : map.pdos) {
    if (!pdo.is_rpdo) continue;
    for (const MapField& field : pdo.fields) {
      for (unsigned axis = 0; axis < most_axes; ++axis) {
        for (const ObjectKey role : set_point_objects) {
          if (field.object != axis_object(axis, role.index, role.sub)) continue;
          axes.push_back({.name = name_of(map, pdo, axis),
                          .node = pdo.node,
                          .axis = axis,
                          .set_point = field.object,
                          .set_point_id = id,
                          .by_velocity = role.index == 0x60FF,
                          .settings = settings_of(map, pdo, axis)});
        }
      }
    }
  }
  std::ranges::sort(axes, {}, [](const AxisRecord& axis) {
    return std::tuple{axis.node, axis.axis, axis.by_velocity, axis.set_point};
  });
  return axes;
}

void keep_used_set_points(std::vector<AxisRecord>& axes) {
  std::vector<AxisRecord> kept;
  for (AxisRecord& axis : axes) {
    const bool same =
        !kept.empty() && kept.back().node == axis.node && kept.back().axis == axis.axis;
    if (!same) {
      kept.push_back(std::move(axis));
    } else if (use_of(axis) > use_of(kept.back())) {
      kept.back() = std::move(axis);
    }
  }
  axes = std::move(kept);
}

std::vector<Sample>* samples_of(AxisRecord& axis, ObjectKey object, bool output) {
  if (output && object == axis.set_point) return &axis.set_points;
  if (object.sub != 0) return nullptr;
  const unsigned role = object.index - axis.axis * 0x800U;
  if (output) {
    if (role == 0x6040) return &axis.controlwords;
    return role == 0x6060 ? &axis.asked_modes : nullptr;
  }
  if (role == 0x6064) return &axis.positions;
  if (role == 0x606C) return &axis.velocities;
  if (role == 0x6041) return &axis.statuswords;
  return role == 0x6061 ? &axis.modes : nullptr;
}

BusRecord make_record(const Trace& trace, const PdoMap& map) {
  return RecordMaker{trace, map}.make();
}

}  // namespace takt::smooth
