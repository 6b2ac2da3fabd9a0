#pragma once
#include <filesystem>

#include "eds_parser/dictionary/object_dictionary.hpp"
#include "eds_parser/report/source.hpp"

namespace takt {

/// Reads the files that a DCF names for its DOMAIN objects (DownloadFile), relative to its folder.
/// A file that is missing, empty or larger than 16 MB is an error at the line that names it.
void read_domain_files(const std::filesystem::path& dcf, ObjectDictionary& dictionary,
                       Findings& findings);

}  // namespace takt
