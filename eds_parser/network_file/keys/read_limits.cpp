#include "eds_parser/network_file/keys/sections.hpp"

namespace takt {
namespace {

constexpr IntegerRange axis_numbers{1, 8, "(axes of a device)"};  // CiA 402: 8 axes, 0x800 apart

/// Reads a limit without a sign, which must be greater than zero.
template <auto Member>
void magnitude(const KeyInput& in, typename KeyTarget<decltype(Member)>::Type& limits) {
  set(in, limits.*Member);
  if (!(limits.*Member).given || in.key.value.numbers.contains(*(limits.*Member))) return;
  in.error("out-of-range", in.what(),
           " has to be above 0: the limit applies to both directions; to forbid a motion, leave "
           "the output out of the mapping");
  (limits.*Member).given = false;
}

/// Reads `[lo, hi]`, in this order.
void read_range(const KeyInput& in, AxisLimitsSpec& limits) {
  if (in.node.kind != YamlNode::Kind::sequence || in.node.items.size() != 2) {
    return in.error("wrong-type", in.what(),
                    " has to be the lowest and the highest value: [-1.5, 1.5]");
  }
  const auto& items = in.node.items;
  const auto low = read_number(*items[0], in.key.name, in.report());
  const auto high = read_number(*items[1], in.key.name, in.report());
  if (!low || !high) return;
  if (*low >= *high) {
    return in.error("out-of-range", in.what(),
                    " has to begin with the lower value: ", items[0]->text, " is not below ",
                    items[1]->text);
  }
  limits.position = {{*low, *high}, in.node.pos, true};
}

template <auto Member>
constexpr auto magnitude_key(std::string_view name, std::string_view meaning) {
  return key<magnitude<Member>>(name, number_above(0), "none", meaning);
}

constexpr Key<AxisLimitsSpec> axis_keys[] = {
    key<read_range>("position", {.type = KeyType::pair}, "none",
                    "The range of set-points: 0x607A or 0x60C1, plus the "
                    "position offset 0x60B0."),
    magnitude_key<&AxisLimitsSpec::velocity>(
        "velocity",
        "Applies to the change of positions per cycle, to 0x60FF plus the velocity offset 0x60B1, "
        "and to 0x6081."),
    magnitude_key<&AxisLimitsSpec::acceleration>(
        "acceleration",
        "Applies to the second difference of positions, to the difference of velocities (0x60FF "
        "plus 0x60B1) except in profile velocity mode, and to 0x6083 and 0x6084."),
    magnitude_key<&AxisLimitsSpec::jerk>(
        "jerk", "Limits planned motions only; takt does not check set-points against it."),
    magnitude_key<&AxisLimitsSpec::following_error>(
        "following_error",
        "The largest following error in a motion that `taktd` runs, which stops the motion."),
    magnitude_key<&AxisLimitsSpec::step>(
        "step", "Change of a position set-point from one cycle to the next."),
    magnitude_key<&AxisLimitsSpec::torque>("torque",
                                           "Applies to 0x6071 plus the torque offset 0x60B2."),
    magnitude_key<&AxisLimitsSpec::modulo>(
        "modulo",
        "The length after which a rotary axis wraps around. Without it, 0x607B in `sdo` counts."),
};

void check_object_limit(const KeyInput& in, std::vector<ObjectLimitSpec>& objects,
                        const ObjectLimitSpec& limit) {
  const std::string what = "the limits of " + to_string(limit.object) + " in " + in.map.what();
  if (!limit.min.given && !limit.max.given && !limit.step.given) {
    in.error("missing-key", what, " lack `min`, `max` or `step`");
  } else if (limit.min.given && limit.max.given && *limit.min >= *limit.max) {
    in.report().error(limit.min.pos, "out-of-range", what, ": `min` is not below `max`");
  }
  for (const ObjectLimitSpec& other : objects) {
    if (other.object != limit.object) continue;
    in.error("written-twice", what, " are written twice, first in line ", other.pos.line,
             ": keep one");
  }
}

constexpr Key<ObjectLimitSpec> object_limit_keys[] = {
    index_key<ObjectLimitSpec>(),
    sub_index_key<ObjectLimitSpec>(),
    key<&ObjectLimitSpec::min>("min", "none", "The lowest value."),
    key<&ObjectLimitSpec::max>("max", "none", "The highest value."),
    magnitude_key<&ObjectLimitSpec::step>("step", "The change from one cycle to the next."),
};

void read_axes(const KeyInput& in, LimitsSpec& limits) {
  if (in.node.kind == YamlNode::Kind::null) return;
  if (in.node.kind != YamlNode::Kind::map) {
    return in.error("wrong-type", in.what(),
                    " has to be a map of axis numbers: {2: {velocity: 1.0}}");
  }
  for (const YamlPair& pair : in.node.pairs) {
    const auto axis = read_number_key(pair, in.key.name, axis_numbers, in.report());
    if (!axis) continue;
    AxisOverrideSpec& entry = limits.axes.emplace_back();
    entry.axis = static_cast<std::uint8_t>(*axis);
    entry.pos = pair.key_pos;
    read_map(*pair.value, in.map.what() + ", axis " + pair.key, axis_keys, entry.limits,
             in.report());
  }
}

constexpr Key<LimitsSpec> limits_keys[] = {
    group<&LimitsSpec::all, axis_keys>(),
    key<read_axes>("axes",
                   {.type = KeyType::numbered, .range = axis_numbers, .parts = rows_of<axis_keys>},
                   "none", "What differs for an axis of the device, by its number."),
    list_key<&LimitsSpec::objects, object_limit_keys, check_object_limit>(
        "objects", "none", "The limits of other outputs."),
};

}  // namespace

void read_limits(const KeyInput& in, NodeSpec& node) {
  read_map(in.node, in.what(), limits_keys, node.limits, in.report());
}

KeyRows limits_rows() { return rows_of<limits_keys>(); }

}  // namespace takt
