#include <algorithm>
#include <array>

#include "eds_parser/network_file/sections.hpp"

namespace takt {
namespace {

bool is_scalar(const YamlNode& node) { return node.kind == YamlNode::Kind::scalar; }

bool says_no(const YamlNode& node) {
  constexpr std::array<std::string_view, 4> words{"false", "False", "no", "off"};
  return is_scalar(node) && std::ranges::find(words, node.text) != words.end();
}

/// Other programs take each number except 0 as true, and some files have a time in ms here.
void read_consumer(MapReader& reader, Sourced<bool>& consumer) {
  constexpr std::string_view key = "heartbeat_consumer";
  const YamlNode* node = reader.take(key);
  if (node == nullptr) return;
  const bool number = is_scalar(*node) && node->text.size() > 1 &&
                      node->text.find_first_not_of("0123456789") == std::string::npos;
  if (!number) return reader.boolean(key, consumer);
  consumer = {node->text.find_first_not_of('0') != std::string::npos, node->pos, true};
  reader.report().warning(node->pos, "wrong-type",
                          "`heartbeat_consumer` has to be true or false; " + node->text +
                              " is read as " +
                              (*consumer ? "true: the accepted silence is `heartbeat_producer` of "
                                           "the watched node times `heartbeat_multiplier`"
                                         : "false"));
}

void read_producer(MapReader& reader, Sourced<std::uint16_t>& producer) {
  constexpr std::string_view key = "heartbeat_producer";
  const YamlNode* node = reader.take(key);
  if (node == nullptr) return;
  if (!says_no(*node)) return reader.integer(key, producer, {0, 65535, " ms"});
  producer = {0, node->pos, true};
  reader.report().warning(
      node->pos, "wrong-type",
      "`heartbeat_producer` has to be a time in ms; " + node->text + " is read as 0: no heartbeat");
}

}  // namespace

void read_heartbeat_ends(MapReader& reader, Sourced<bool>& consumer,
                         Sourced<std::uint16_t>& producer) {
  read_consumer(reader, consumer);
  read_producer(reader, producer);
}

}  // namespace takt
