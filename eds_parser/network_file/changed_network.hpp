#pragma once
#include <filesystem>

#include "eds_parser/budget/what_if.hpp"
#include "eds_parser/network_file/load_network.hpp"

namespace takt {

/// As load_network(), with other values than those of the file. A node of `changes` that is not
/// there is an error.
LoadedNetwork load_changed_network(const std::filesystem::path& path, const WhatIf& changes);

}  // namespace takt
