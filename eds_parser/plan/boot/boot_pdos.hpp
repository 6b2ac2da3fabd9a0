#pragma once
#include "eds_parser/plan/boot/boot_steps.hpp"
#include "eds_parser/plan/pdo/effective_pdo.hpp"

namespace takt {

/// Appends the steps for one PDO. They compare the PDO with its settings in the device. If anything
/// differs, they configure the PDO in the order that devices accept (CiA 301, 7.5.2.36) and read it
/// back. A fixed mapping is only checked.
void append_pdo(const ObjectDictionary& dictionary, const EffectivePdo& pdo, BootSteps& steps);

}  // namespace takt
