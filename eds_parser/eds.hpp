#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "eds_parser/object_dictionary.hpp"
#include "eds_parser/source.hpp"

namespace takt {

/// What became of reading an EDS or DCF. Where `readable` is false the findings say why; otherwise
/// the dictionary holds all that could be taken.
struct EdsFile {
  ObjectDictionary dictionary;
  Findings findings;
  bool readable = false;
};

/// Reads the text of an EDS or DCF. `node` overrides the file's own node id in $NODEID formulas.
/// Never throws on content; work and memory are bounded by the length of the text.
EdsFile read_eds(std::string_view text, std::string file_name, std::optional<NodeId> node = {});
/// Same, from a file.
EdsFile read_eds_file(const std::filesystem::path& path, std::optional<NodeId> node = {});

}  // namespace takt
