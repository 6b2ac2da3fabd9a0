#include <cmath>
#include <limits>

#include "eds_parser/network_file/sections.hpp"

namespace takt {
namespace {

constexpr std::int64_t most_axes = 8;  // CiA 402: objects of axis n at 0x6000 + 0x800 (n - 1)

/// Reports a value that is not finite, and returns false for it.
bool check_finite(double value, SourcePos pos, const std::string& what, NetworkReport& report) {
  if (std::isfinite(value)) return true;
  report.error(pos, "out-of-range", what + " has to be a finite number");
  return false;
}

/// Reads a magnitude, which must be above zero.
void read_magnitude(MapReader& reader, std::string_view key, Sourced<double>& out) {
  reader.number(key, out);
  if (!out.given) return;
  const std::string what = "`" + std::string{key} + "` of " + reader.what();
  if (!check_finite(*out, out.pos, what, reader.report())) {
    out.given = false;
  } else if (*out <= 0) {
    reader.report().error(out.pos, "out-of-range",
                          what +
                              " has to be above 0: the limit applies to both directions; to forbid "
                              "a motion, leave the output out of the mapping");
    out.given = false;
  }
}

/// Reads `[lo, hi]`, in this order.
void read_range(MapReader& reader, std::string_view key, Sourced<RangeSpec>& out) {
  const YamlNode* list = reader.take(key);
  if (list == nullptr) return;
  const std::string what = "`" + std::string{key} + "` of " + reader.what();
  if (list->kind != YamlNode::Kind::sequence || list->items.size() != 2) {
    reader.report().error(list->pos, "wrong-type",
                          what + " has to be the lowest and the highest value: [-1.5, 1.5]");
    return;
  }
  const auto low = read_number(*list->items[0], key, reader.report());
  const auto high = read_number(*list->items[1], key, reader.report());
  if (!low || !high || !check_finite(*low, list->items[0]->pos, what, reader.report()) ||
      !check_finite(*high, list->items[1]->pos, what, reader.report())) {
    return;
  }
  if (*low >= *high) {
    reader.report().error(list->pos, "out-of-range",
                          what + " has to begin with the lower value: " + list->items[0]->text +
                              " is not below " + list->items[1]->text);
    return;
  }
  out = {{*low, *high}, list->pos, true};
}

AxisLimitsSpec read_axis(MapReader& reader) {
  AxisLimitsSpec limits;
  read_range(reader, "position", limits.position);
  read_magnitude(reader, "velocity", limits.velocity);
  read_magnitude(reader, "acceleration", limits.acceleration);
  read_magnitude(reader, "jerk", limits.jerk);
  read_magnitude(reader, "step", limits.step);
  read_magnitude(reader, "torque", limits.torque);
  read_magnitude(reader, "modulo", limits.modulo);
  return limits;
}

void read_axes(const YamlNode& map, const std::string& owner, LimitsSpec& limits,
               NetworkReport& report) {
  if (map.kind != YamlNode::Kind::map) {
    report.error(map.pos, "wrong-type",
                 "`axes` in `limits` of " + owner +
                     " has to be a map of axis numbers: {2: {velocity: 1.0}}");
    return;
  }
  for (const YamlPair& pair : map.pairs) {
    YamlNode number;
    number.kind = YamlNode::Kind::scalar;
    number.text = pair.key;
    number.pos = pair.key_pos;
    const auto axis = read_integer(number, "axes", {1, most_axes, " (axes of a device)"}, report);
    if (!axis) continue;
    MapReader reader{*pair.value, "`limits` of axis " + pair.key + " of " + owner, report};
    AxisOverrideSpec& entry = limits.axes.emplace_back();
    entry.axis = static_cast<std::uint8_t>(*axis);
    entry.pos = pair.key_pos;
    entry.limits = read_axis(reader);
    reader.finish();
  }
}

void read_object_limit(const YamlNode& item, const std::string& owner, LimitsSpec& limits,
                       NetworkReport& report) {
  MapReader reader{item, "an entry of `limits: objects` of " + owner, report};
  const auto key = read_object_key(reader, item.pos);
  ObjectLimitSpec limit;
  limit.pos = item.pos;
  reader.number("min", limit.min);
  reader.number("max", limit.max);
  read_magnitude(reader, "step", limit.step);
  reader.finish();
  if (!key) return;
  limit.object = *key;
  const std::string what = "the limits of " + to_string(*key) + " of " + owner;
  for (const Sourced<double>* bound : {&limit.min, &limit.max}) {
    if (bound->given && !check_finite(**bound, bound->pos, what, report)) return;
  }
  if (!limit.min.given && !limit.max.given && !limit.step.given) {
    report.error(item.pos, "missing-key", what + " lack `min`, `max` or `step`");
    return;
  }
  if (limit.min.given && limit.max.given && *limit.min >= *limit.max) {
    report.error(limit.min.pos, "out-of-range", what + ": `min` is not below `max`");
    return;
  }
  for (const ObjectLimitSpec& other : limits.objects) {
    if (other.object != *key) continue;
    report.error(item.pos, "written-twice",
                 what + " are written twice, first in line " + std::to_string(other.pos.line) +
                     ": keep one");
    return;
  }
  limits.objects.push_back(limit);
}

}  // namespace

LimitsSpec read_limits(const YamlNode& node, const std::string& owner, NetworkReport& report) {
  LimitsSpec limits;
  MapReader reader{node, "`limits` of " + owner, report};
  limits.all = read_axis(reader);
  if (const YamlNode* axes = reader.take("axes")) read_axes(*axes, owner, limits, report);
  if (const YamlNode* list = reader.take("objects")) {
    if (list->kind != YamlNode::Kind::sequence) {
      report.error(
          list->pos, "wrong-type",
          "`objects` in `limits` of " + owner +
              " has to be a list of `{index: 0x6411, sub_index: 1, min: 0, max: 10, step: 0.5}`");
    }
    for (const YamlNode* item : list->items) read_object_limit(*item, owner, limits, report);
  }
  reader.finish();
  return limits;
}

}  // namespace takt
