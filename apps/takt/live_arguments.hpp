#pragma once
#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "eds_parser/table/ids.hpp"
#include "eds_parser/table/time.hpp"

namespace takt {

/// Options that all verbs have which talk to a running daemon.
struct LiveOptions {
  std::string lcm_url;
  std::string bus_name;  ///< empty: the only one there is
  bool json = false;
  std::string keys;           ///< key file; empty: messages are sent without an envelope
  bool check_images = false;  ///< only what the daemon has signed is believed
};

void add_live_options(CLI::App& verb, LiveOptions& options);

/// `6041`, `6041:00`, `0x1018:1`; index and sub-index in hex.
std::optional<ObjectKey> parse_object(std::string_view text);

/// `5`, `0x05`; none: not a node id (a name, perhaps).
std::optional<NodeId> parse_node_id(std::string_view text);

/// Prints "takt: ..." on stderr, as far as it is printable, and gives `code`.
int complain(const std::string& sentence, int code);

}  // namespace takt
