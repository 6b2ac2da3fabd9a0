#include <algorithm>
#include <array>

#include "eds_parser/network_file/keys/sections.hpp"

namespace takt {
namespace {

bool is_scalar(const YamlNode& node) { return node.kind == YamlNode::Kind::scalar; }

bool says_no(const YamlNode& node) {
  constexpr std::array<std::string_view, 4> words{"false", "False", "no", "off"};
  return is_scalar(node) && std::ranges::find(words, node.text) != words.end();
}

}  // namespace

void read_consumer(const KeyInput& in, Sourced<bool>& consumer) {
  const std::string& text = in.node.text;
  const bool number = is_scalar(in.node) && text.size() > 1 &&
                      text.find_first_not_of("0123456789") == std::string::npos;
  if (!number) return set(in, consumer);
  consumer = {text.find_first_not_of('0') != std::string::npos, in.node.pos, true};
  in.report().warning(in.node.pos, "wrong-type", "`heartbeat_consumer` has to be true or false; ",
                      text, " is read as ",
                      *consumer ? "true: the accepted silence is `heartbeat_producer` of the "
                                  "watched node times `heartbeat_multiplier`"
                                : "false");
}

void read_producer(const KeyInput& in, Sourced<std::uint16_t>& producer) {
  if (!says_no(in.node)) return set(in, producer);
  producer = {0, in.node.pos, true};
  in.report().warning(in.node.pos, "wrong-type", "`heartbeat_producer` has to be a time in ms; ",
                      in.node.text, " is read as 0: no heartbeat");
}

void read_multiplier(const KeyInput& in, Sourced<double>& multiplier) {
  set(in, multiplier);
  if (!multiplier.given || in.key.value.numbers.contains(*multiplier)) return;
  in.error("out-of-range",
           "`heartbeat_multiplier` has to be at least 1.5, otherwise one late heartbeat counts as "
           "a loss");
}

}  // namespace takt
