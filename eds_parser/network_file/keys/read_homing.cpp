#include "eds_parser/network_file/keys/sections.hpp"

namespace takt {
namespace {

constexpr IntegerRange numbers_of_axes{1, 8, "(axes of a device)"};  // CiA 402: 8 axes, 0x800 apart

template <auto Member>
void positive(const KeyInput& in, AxisHomingSpec& homing) {
  set(in, homing.*Member);
  if (!(homing.*Member).given || in.key.value.numbers.contains(*(homing.*Member))) return;
  in.error("out-of-range", in.what(), " has to be above 0: the method decides on the direction");
  (homing.*Member).given = false;
}

template <auto Member>
constexpr auto positive_key(std::string_view name, std::string_view meaning) {
  return key<positive<Member>>(name, number_above(0), "as in the device", meaning);
}

constexpr Key<AxisHomingSpec> axis_homing_keys[] = {
    key<&AxisHomingSpec::required>(
        "required", "true",
        "`taktd` refuses absolute motions until the axis is homed. false: for a drive that knows "
        "its position without homing."),
    key<&AxisHomingSpec::method>("method", whole(-128, 127), "as in the device",
                                 "The homing method (0x6098), for example 35: the present position "
                                 "becomes the home position."),
    positive_key<&AxisHomingSpec::speed_switch>(
        "speed_switch", "The speed of the search for a switch (0x6099:01)."),
    positive_key<&AxisHomingSpec::speed_zero>(
        "speed_zero", "The speed of the search for the zero or index (0x6099:02)."),
    positive_key<&AxisHomingSpec::acceleration>("acceleration", "The acceleration (0x609A)."),
    key<&AxisHomingSpec::offset>("offset", "as in the device",
                                 "The home offset (0x607C), a difference of positions."),
    key<&AxisHomingSpec::timeout>("timeout", whole(1, 3'600'000, "ms"), "60000",
                                  "The longest time of a homing run."),
};

void read_homing_of_axes(const KeyInput& in, HomingSpec& homing) {
  if (in.node.kind == YamlNode::Kind::null) return;
  if (in.node.kind != YamlNode::Kind::map) {
    return in.error("wrong-type", in.what(), " has to be a map of axis numbers: {2: {method: 35}}");
  }
  for (const YamlPair& pair : in.node.pairs) {
    const auto axis = read_number_key(pair, in.key.name, numbers_of_axes, in.report());
    if (!axis) continue;
    AxisHomingOverrideSpec& entry = homing.axes.emplace_back();
    entry.axis = static_cast<std::uint8_t>(*axis);
    entry.pos = pair.key_pos;
    read_map(*pair.value, in.map.what() + ", axis " + pair.key, axis_homing_keys, entry.homing,
             in.report());
  }
}

constexpr Key<HomingSpec> homing_keys[] = {
    group<&HomingSpec::all, axis_homing_keys>(),
    key<read_homing_of_axes>(
        "axes",
        {.type = KeyType::numbered, .range = numbers_of_axes, .parts = rows_of<axis_homing_keys>},
        "none", "What differs for an axis of the device, by its number."),
};

}  // namespace

void read_homing(const KeyInput& in, NodeSpec& node) {
  node.homing.given = true;
  node.homing.pos = in.node.pos;
  if (in.node.kind == YamlNode::Kind::scalar) return set(in, node.homing.all.method);
  read_map(in.node, in.what(), homing_keys, node.homing, in.report());
}

KeyRows homing_rows() { return rows_of<homing_keys>(); }

}  // namespace takt
