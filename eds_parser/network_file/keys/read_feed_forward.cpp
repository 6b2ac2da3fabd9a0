#include "eds_parser/network_file/keys/sections.hpp"

namespace takt {
namespace {

constexpr IntegerRange feed_forward_axes{1, 8,
                                         "(axes of a device)"};  // CiA 402: 8 axes, 0x800 apart

/// Checks that a mass or a friction is not negative. If a positive torque moves the axis in the
/// negative direction, the scale of the torque unit is negative instead.
template <auto Member>
void not_negative(const KeyInput& in, AxisFeedForwardSpec& feed_forward) {
  set(in, feed_forward.*Member);
  const auto& value = feed_forward.*Member;
  if (!value.given || in.key.value.numbers.contains(*value)) return;
  in.error("out-of-range", in.what(),
           " has to be 0 or above; if positive torque moves the axis in the negative direction, "
           "give `units: {torque: ...}` a negative scale");
  (feed_forward.*Member).given = false;
}

constexpr Key<AxisFeedForwardSpec> axis_feed_forward_keys[] = {
    key<not_negative<&AxisFeedForwardSpec::torque_per_acceleration>>(
        "torque_per_acceleration", number_within({.low = 0}), "0",
        "The torque that an acceleration of 1 needs: the inertia of the axis."),
    key<not_negative<&AxisFeedForwardSpec::torque_per_velocity>>(
        "torque_per_velocity", number_within({.low = 0}), "0",
        "The torque that a velocity of 1 needs: the viscous friction of the axis."),
};

void read_feed_forward_of_axes(const KeyInput& in, FeedForwardSpec& feed_forward) {
  if (in.node.kind == YamlNode::Kind::null) return;
  if (in.node.kind != YamlNode::Kind::map) {
    return in.error("wrong-type", in.what(),
                    " has to be a map of axis numbers: {2: {torque_per_acceleration: 0.01}}");
  }
  for (const YamlPair& pair : in.node.pairs) {
    const auto axis = read_number_key(pair, in.key.name, feed_forward_axes, in.report());
    if (!axis) continue;
    AxisFeedForwardOverrideSpec& entry = feed_forward.axes.emplace_back();
    entry.axis = static_cast<std::uint8_t>(*axis);
    entry.pos = pair.key_pos;
    read_map(*pair.value, in.map.what() + ", axis " + pair.key, axis_feed_forward_keys,
             entry.feed_forward, in.report());
  }
}

constexpr Key<FeedForwardSpec> feed_forward_keys[] = {
    group<&FeedForwardSpec::all, axis_feed_forward_keys>(),
    key<read_feed_forward_of_axes>("axes",
                                   {.type = KeyType::numbered,
                                    .range = feed_forward_axes,
                                    .parts = rows_of<axis_feed_forward_keys>},
                                   "none",
                                   "What differs for an axis of the device, by its number."),
};

}  // namespace

void read_feed_forward(const KeyInput& in, NodeSpec& node) {
  node.feed_forward.given = true;
  node.feed_forward.pos = in.node.pos;
  read_map(in.node, in.what(), feed_forward_keys, node.feed_forward, in.report());
}

KeyRows feed_forward_rows() { return rows_of<feed_forward_keys>(); }

}  // namespace takt
