#pragma once
#include "eds_parser/budget/what_if.hpp"
#include "eds_parser/network_spec.hpp"
#include "eds_parser/source.hpp"

namespace takt {

/// Replaces values of the network file by those of `changes`.
void apply_changes(const WhatIf& changes, NetworkSpec& spec, Findings& findings);

}  // namespace takt
