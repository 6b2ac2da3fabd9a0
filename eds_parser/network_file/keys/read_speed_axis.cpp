#include "eds_parser/network_file/keys/sections.hpp"

namespace takt {
namespace {

constexpr std::string_view sequence_words[] = {"words", "cia402"};
constexpr std::string_view fault_reset_words[] = {"edge", "level"};
constexpr KeyValue word16 = whole(0, 0xFFFF);

constexpr Key<ObjectKey> speed_object_keys[] = {
    required(key<&ObjectKey::index>("index", whole(0x1000, 0xFFFF), "", "The index.")),
    key<&ObjectKey::sub>("sub_index", "0", "The sub-index."),
};

void read_speed_scale(const KeyInput& in, SpeedValueSpec& value) {
  set(in, value.scale);
  if (value.scale != 0.0) return;
  in.error("out-of-range", in.what(), " must not be 0");
  value.scale = 1.0;
}

constexpr Key<SpeedValueSpec> speed_keys[] = {
    group<&SpeedValueSpec::object, speed_object_keys>(),
    key<read_speed_scale>("scale", {.type = KeyType::number}, "1",
                          "The speed of one count, in `unit`; a negative one reverses the axis."),
    key<&SpeedValueSpec::unit>("unit", "none", "The unit of speeds, `rpm` or `Hz`."),
};

constexpr Key<SpeedCommandsSpec> command_keys[] = {
    key<&SpeedCommandsSpec::mask>("mask", word16, "0xFFFF",
                                  "The bits of the control word that hold the command."),
    key<&SpeedCommandsSpec::off>("off", word16, "as `stop`", "The drive must not move."),
    key<&SpeedCommandsSpec::stop>("stop", word16, "required",
                                  "The drive stops along its ramp and stays at standstill."),
    key<&SpeedCommandsSpec::run>("run", word16, "required",
                                 "The drive follows the set speed: forward if there is "
                                 "`run_reverse`, otherwise by its sign."),
    key<&SpeedCommandsSpec::run_reverse>("run_reverse", word16, "none",
                                         "The drive follows the set speed backward. The set speed "
                                         "is then sent without a sign."),
    key<&SpeedCommandsSpec::quick_stop>("quick_stop", word16, "none",
                                        "The drive stops as fast as it can."),
    key<&SpeedCommandsSpec::reset>("reset", word16, "none", "Fault reset."),
};

void read_values(const KeyInput& in, WordPattern& pattern) {
  if (in.node.kind != YamlNode::Kind::sequence || in.node.items.empty() ||
      in.node.items.size() > 64) {
    return in.error("wrong-type", in.what(), " has to be a list of values: [0x0800, 0x0B00]");
  }
  for (const YamlNode* item : in.node.items) {
    const auto value = read_integer(*item, in.key.name, in.key.value.entries, in.report());
    if (value) pattern.values.push_back(static_cast<std::uint16_t>(*value));
  }
}

constexpr Key<WordPattern> pattern_keys[] = {
    required(key<&WordPattern::mask>("mask", whole(1, 0xFFFF), "",
                                     "The bits of the status word that show the state.")),
    key<read_values>("values", {.type = KeyType::list, .entries = word16.range}, "all bits 1",
                     "These bits have one of these values in the state."),
};

/// Completes a pattern, and reports a value with bits outside the mask, which could never match.
void check_pattern(const KeyInput& in, WordPattern& pattern) {
  if (pattern.values.empty()) pattern.values = {pattern.mask};
  for (const std::uint16_t value : pattern.values) {
    if ((value & ~pattern.mask) == 0) continue;
    in.error("out-of-range", in.what(), ": the value ", hex(value, 4),
             " has bits outside the mask ", hex(pattern.mask, 4), ", so it is never seen");
  }
}

constexpr Key<SpeedStates> state_keys[] = {
    map_key<&SpeedStates::ready, pattern_keys, check_pattern>(
        "ready", "not shown", "The drive executes the command to run."),
    map_key<&SpeedStates::running, pattern_keys, check_pattern>("running", "not shown",
                                                                "The motor is under power."),
    map_key<&SpeedStates::reverse, pattern_keys, check_pattern>(
        "reverse", "not shown",
        "The drive turns backward. The actual speed is then a value without a sign."),
    map_key<&SpeedStates::at_speed, pattern_keys, check_pattern>("at_speed", "not shown",
                                                                 "The set speed is reached."),
    map_key<&SpeedStates::standstill, pattern_keys, check_pattern>("standstill", "actual speed 0",
                                                                   "The drive is at standstill."),
    map_key<&SpeedStates::fault, pattern_keys, check_pattern>("fault", "not shown",
                                                              "The drive has a fault."),
};

template <auto Member>
void read_word(const KeyInput& in, SpeedAxisSpec& axis) {
  typename std::remove_reference_t<decltype(axis.*Member)>::value_type value{};
  if (read_value(in, value)) axis.*Member = value;
}

constexpr Key<SpeedAxisSpec> speed_axis_keys[] = {
    key<&SpeedAxisSpec::enabled>("enabled", "true",
                                 "false: the node is no speed axis, whatever its device data say."),
    key<read_word<&SpeedAxisSpec::sequence>>(
        "sequence", word_of(sequence_words), "`words`",
        "`words`: each command is one value of the control word. `cia402`: the state machine of "
        "CiA 402, with the commands in operation enabled."),
    map_key<&SpeedAxisSpec::control, speed_object_keys>("control", "required", "The control word."),
    map_key<&SpeedAxisSpec::status, speed_object_keys>("status", "required", "The status word."),
    map_key<&SpeedAxisSpec::set_speed, speed_keys>("set_speed", "required", "The set speed."),
    map_key<&SpeedAxisSpec::actual_speed, speed_keys>("actual_speed", "none", "The actual speed."),
    map_key<&SpeedAxisSpec::commands, command_keys>("commands", "required",
                                                    "Values of the control word."),
    map_key<&SpeedAxisSpec::states, state_keys>("states", "not shown",
                                                "What the status word shows."),
    key<read_word<&SpeedAxisSpec::fault_reset>>("fault_reset", word_of(fault_reset_words), "`edge`",
                                                "`edge`: the change to `reset` resets the fault. "
                                                "`level`: the value `reset` resets the fault."),
    key<&SpeedAxisSpec::ramps>("ramps", "none",
                               "Where the ramps of the drive are set: text for `takt plan`."),
    key<&SpeedAxisSpec::source>("source", "none",
                                "Where the facts come from, if not from the manual."),
};

}  // namespace

void read_speed_axis(const KeyInput& in, SpeedAxisSpec& axis) {
  read_map(in.node, in.what(), speed_axis_keys, axis, in.report());
}

KeyRows speed_axis_rows() { return rows_of<speed_axis_keys>(); }

}  // namespace takt
