#pragma once
#include <filesystem>

#include "eds_parser/budget/what_if.hpp"
#include "eds_parser/network_file/load_network.hpp"

namespace takt {

/// Loads a network file as load_network() does, but replaces values of the file by those of
/// `changes`. A node of `changes` that the file does not have is an error.
LoadedNetwork load_changed_network(const std::filesystem::path& path, const WhatIf& changes);

}  // namespace takt
