#pragma once
#include "eds_parser/budget/what_if.hpp"
#include "eds_parser/network_spec.hpp"
#include "eds_parser/source.hpp"

namespace takt {

/// Puts the values of `changes` in place of those of the file.
void apply_changes(const WhatIf& changes, NetworkSpec& spec, Findings& findings);

}  // namespace takt
