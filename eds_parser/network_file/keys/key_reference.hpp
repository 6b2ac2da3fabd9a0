#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "eds_parser/network_file/yaml/key_table.hpp"

namespace takt {

/// The keys of one map.
struct KeySection {
  std::string name;  ///< heading, for example "nodes: limits: objects"
  KeyRows keys;
};

/// Returns the sections of a network file, each followed by the maps in it. Maps with the same keys
/// are listed once.
std::vector<KeySection> network_file_keys();
/// Returns the sections of a device data file as network_file_keys() returns those of a network
/// file. The section of the whole file is named "entry".
std::vector<KeySection> device_data_keys();

/// Returns what a key accepts, in words and Markdown: "0..60000000 us", "true, false or a map".
std::string value_text(const KeyValue& value);

/// Returns the keys as Markdown tables, each below a line with the name of its section.
std::string key_reference(const std::vector<KeySection>& sections);

/// Returns what a key of a network file means, or why takt accepts it without effect. `section` is
/// the one in which the key is written; the name of a node counts as a section. Returns an empty
/// text if takt does not know the key.
std::string_view key_meaning(std::string_view section, std::string_view key);

}  // namespace takt
