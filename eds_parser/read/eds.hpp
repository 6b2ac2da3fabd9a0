#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "eds_parser/dictionary/object_dictionary.hpp"
#include "eds_parser/report/source.hpp"

namespace takt {

/// The result of reading an EDS or DCF. If `readable` is false, the findings give the reason.
/// Otherwise the dictionary holds everything that could be read.
struct EdsFile {
  ObjectDictionary dictionary;
  Findings findings;
  bool readable = false;
};

/// Reads the text of an EDS or DCF. `node` overrides the file's own node-ID in $NODEID formulas.
/// The content never causes an exception. The length of the text bounds time and memory.
EdsFile read_eds(std::string_view text, std::string file_name, std::optional<NodeId> node = {});
/// Reads an EDS or DCF from a file, with the same rules.
EdsFile read_eds_file(const std::filesystem::path& path, std::optional<NodeId> node = {});

}  // namespace takt
