#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "eds_parser/budget/what_if.hpp"
#include "eds_parser/dictionary/object_dictionary.hpp"
#include "eds_parser/report/source.hpp"
#include "eds_parser/specification/network_spec.hpp"

namespace takt {

// Steps of loading a network file.

/// Replaces values of the network file by those of `changes`.
void apply_changes(const WhatIf& changes, NetworkSpec& spec, Findings& findings);

/// Reads the files that a DCF names for its DOMAIN objects (DownloadFile), relative to its folder.
/// A file that is missing, empty or larger than 16 MB is an error at the line that names it.
void read_domain_files(const std::filesystem::path& dcf, ObjectDictionary& dictionary,
                       Findings& findings);

/// Joins findings that have the same cause. Lines of a network file may belong to several nodes,
/// because they are in `defaults` or in a YAML anchor that is merged into the nodes. A mistake
/// there gives one finding, which names the other nodes. Findings of the same place, severity and
/// rule are joined if they differ only in the name of the node (between backticks) or in "node N".
void join_shared_lines(Findings& findings, std::string_view file,
                       std::span<const std::string> nodes);

}  // namespace takt
