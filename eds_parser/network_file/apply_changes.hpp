#pragma once
#include "eds_parser/budget/what_if.hpp"
#include "eds_parser/report/source.hpp"
#include "eds_parser/specification/network_spec.hpp"

namespace takt {

/// Replaces values of the network file by those of `changes`.
void apply_changes(const WhatIf& changes, NetworkSpec& spec, Findings& findings);

}  // namespace takt
