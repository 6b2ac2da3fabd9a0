#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "eds_parser/values/ids.hpp"
#include "eds_parser/values/time.hpp"

namespace CLI {
class App;
}

namespace takt {

/// Options of all verbs that exchange messages with a running daemon.
struct LiveOptions {
  std::string lcm_url;
  std::string bus_name;  ///< empty means the only bus
  bool json = false;
  std::string keys;           ///< key file; if empty, messages are sent without an envelope
  bool check_images = false;  ///< accept only messages that the daemon has signed
};

/// Adds the options that choose the daemon and the bus.
void add_bus_choice(CLI::App& verb, LiveOptions& options);
/// Adds `--keys` and `--check-images`: the options of programs whose daemon may have a key file.
void add_key_options(CLI::App& app, std::string& keys, bool& check_images);
/// Adds the options of add_bus_choice() and of add_key_options(), and `--json`.
void add_live_options(CLI::App& verb, LiveOptions& options);

/// Parses a number of 32 bits without a sign. A number with 0x is hex, whatever the base is.
/// Returns std::nullopt if the text is no such number.
std::optional<std::uint32_t> parse_unsigned(std::string_view text, int base = 10);

/// Parses index and sub-index in hex, for example `6041`, `6041:00` or `0x1018:1`. Returns
/// std::nullopt if the text is no object.
std::optional<ObjectKey> parse_object(std::string_view text);

/// Parses a node-ID, for example `5` or `0x05`. Returns std::nullopt if the text is no node-ID; it
/// may be a name.
std::optional<NodeId> parse_node_id(std::string_view text);

/// Prints "takt: ..." on stderr, with '?' for unprintable characters, and returns `code`.
int complain(const std::string& sentence, int code);

}  // namespace takt
