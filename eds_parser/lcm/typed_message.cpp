#include "eds_parser/lcm/typed_message.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "eds_parser/lcm/lcm_channel.hpp"
#include "eds_parser/values/name_of.hpp"
#include "eds_parser/values/word_list.hpp"

namespace takt {
namespace {

/// Reserved words of C, C++, Java, Python and LCM, names that their C libraries define, and names
/// of functions in generated code. They are in lower case, as field names are.
constexpr std::string_view taken =
    "abstract alignas alignof and as asm assert async auto await bool boolean break byte case "
    "catch char class clone concept const constexpr continue copy decltype decode def default del "
    "delete do double elif else encode enum eof equals errno except exec explicit export extends "
    "extern false final finally finalize float for friend from getclass gethash global goto "
    "hashcode i386 if implements import in inline instanceof int int16_t int32_t int64_t int8_t "
    "interface is lambda linux long mutable namespace native new noexcept none nonlocal not "
    "notify null nullptr operator or package pass print private protected public raise register "
    "requires return self short signed sizeof static stderr stdin stdout strictfp string struct "
    "super switch synchronized template this throw throws transient true try typedef typename "
    "union unix unsigned using virtual void volatile while";

/// Makes an identifier of lower-case letters, digits and `_` that does not begin with a digit and
/// is not a reserved word.
std::string identifier(std::string_view text) {
  std::string name;
  for (const char c : text) {
    const bool upper = c >= 'A' && c <= 'Z';
    const bool word = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
    name += upper ? static_cast<char>(c + ('a' - 'A')) : word ? c : '_';
  }
  // Names that begin with `_` belong to the generated code.
  if (name.empty() || name[0] == '_' || (name[0] >= '0' && name[0] <= '9')) name.insert(0, 1, 'x');
  if (has_word(taken, name)) name += '_';
  return name;
}

std::string unused(std::string name, std::set<std::string>& used) {
  const std::string stem = name;
  for (unsigned n = 2; !used.insert(name).second; ++n) name = stem + '_' + std::to_string(n);
  return name;
}

/// Returns a channel that is not in `used`, and adds it to `used`. A number before `kind` makes a
/// repeated name unique. It stays complete when channel_name() cuts a long name.
std::string unused_channel(const std::string& node, const std::string& kind,
                           std::set<std::string>& used) {
  std::string channel = channel_name(node, kind);
  for (unsigned n = 2; !used.insert(channel).second; ++n) {
    channel = channel_name(node, std::to_string(n) + '_' + kind);
  }
  return channel;
}

bool scaled(const Signal& signal) noexcept {
  return signal.scale != 1.0 || signal.offset != 0.0 || !signal.unit.empty();
}

LcmPrimitive type_of(const Signal& signal) noexcept {
  if (signal.type == DataType::real64 || scaled(signal)) return LcmPrimitive::float64;
  if (signal.type == DataType::real32) return LcmPrimitive::float32;
  if (signal.type == DataType::boolean) return LcmPrimitive::boolean;
  const unsigned bits = signal.bits + (is_signed(signal.type) ? 0U : 1U);
  if (bits <= 8) return LcmPrimitive::int8;
  if (bits <= 16) return LcmPrimitive::int16;
  return bits <= 32 ? LcmPrimitive::int32 : LcmPrimitive::int64;
}

std::string comment_of(const Signal& signal) {
  std::string text = to_string(signal.object) + ' ' + std::string{name(signal.type)};
  if (!signal.unit.empty()) text += ", " + signal.unit;
  const bool is_pattern = signal.bits == 64 && !is_signed(signal.type) && !is_real(signal.type);
  if (!scaled(signal) && is_pattern) text += ", as bit pattern";
  std::erase_if(text, [](char c) { return static_cast<unsigned char>(c) < 0x20; });
  return text;
}

std::vector<TypedField> head_of(bool command) {
  using enum LcmPrimitive;
  if (command) {
    return {
        {"utime", int64, "microseconds since 1970"},
        {"session", int64, "session of the state; commands of another session are refused"},
        {"instance", int64, "instance of the sender: random, chosen when the sender starts, not 0"},
        {"sender", string, "name of the sender in events and in status_t"},
        {"cycle", int64, "cycle of the state from which the set-points were computed"},
        {"time_to_live", int32, "in cycles; 0 = the configured time to live"},
        {"release", boolean, "the sender gives up the node's outputs"}};
  }
  return {{"utime", int64, "wall clock of SYNC, microseconds since 1970"},
          {"sync_mono_ns", int64, "monotonic clock of SYNC"},
          {"session", int64, "session of this run of taktd; commands repeat this number"},
          {"cycle", int64, "number of this SYNC"},
          {"stale", boolean, "a PDO of the node did not arrive when expected"}};
}

TypedMessage message_of(const BusPlan& plan, std::size_t node, bool command) {
  TypedMessage message{.package = identifier(plan.name),
                       .name = {},
                       .channel = {},
                       .node_index = static_cast<std::uint8_t>(node),
                       .command = command,
                       .fields = head_of(command)};
  std::set<std::string> used;
  for (const TypedField& field : message.fields) used.insert(field.name);
  for (std::size_t i = 0; i < plan.layout.signals.size(); ++i) {
    const Signal& signal = plan.layout.signals[i];
    if (signal.node_index != node || signal.output != command) continue;
    message.fields.push_back({.name = unused(identifier(signal.name), used),
                              .type = type_of(signal),
                              .comment = comment_of(signal),
                              .signal = static_cast<SignalIndex>(i)});
  }
  return message;
}

// The fingerprint of lcm-gen uses arithmetic on signed 64-bit numbers, with arithmetic right
// shifts.

std::int64_t mix(std::int64_t value, char c) noexcept {
  const auto shifted = static_cast<std::int64_t>(static_cast<std::uint64_t>(value) << 8U);
  const auto folded = static_cast<std::uint64_t>(shifted ^ (value >> 55));
  return static_cast<std::int64_t>(folded + static_cast<std::uint64_t>(std::int64_t{c}));
}

std::int64_t mix(std::int64_t value, std::string_view text) noexcept {
  value = mix(value, static_cast<char>(text.size()));
  for (const char c : text) value = mix(value, c);
  return value;
}

}  // namespace

std::string_view name(LcmPrimitive type) noexcept {
  static constexpr std::string_view names[]{"boolean", "int8_t", "int16_t", "int32_t",
                                            "int64_t", "float",  "double",  "string"};
  return name_of(type, names);
}

std::uint64_t TypedMessage::fingerprint() const noexcept {
  std::int64_t value = 0x1234'5678;
  for (const TypedField& field : fields) {
    value = mix(value, field.name);
    value = mix(value, takt::name(field.type));
    value = mix(value, '\0');  // the field has no dimensions
  }
  const auto hash = static_cast<std::uint64_t>(value);
  return (hash << 1U) + (hash >> 63U);
}

std::vector<TypedMessage> typed_messages(const BusPlan& plan) {
  std::vector<TypedMessage> messages;
  std::set<std::string> used;
  // The daemon uses these channels. A node named `transfer` or `motion` would otherwise get one of
  // them.
  std::set<std::string> channels{channel_name(plan.name, "TRANSFER_STATE"),
                                 channel_name(plan.name, "MOTION_COMMAND")};
  for (std::size_t node = 0; node < plan.nodes.size(); ++node) {
    for (const bool command : {false, true}) {
      TypedMessage message = message_of(plan, node, command);
      if (!message.fields.back().signal) continue;
      const std::string_view kind = command ? "_command" : "_state";
      message.name = unused(identifier(plan.nodes[node].name) + std::string{kind}, used) + "_t";
      message.channel = unused_channel(plan.name + '_' + plan.nodes[node].name,
                                       command ? "COMMAND" : "STATE", channels);
      messages.push_back(std::move(message));
    }
  }
  return messages;
}

}  // namespace takt
