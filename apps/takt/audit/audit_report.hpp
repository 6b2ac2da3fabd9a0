#pragma once
#include <cstdint>
#include <ostream>

#include "apps/takt/audit/audit.hpp"

namespace takt {

enum class Colour : std::uint8_t { none, ansi };

void print_audit(std::ostream& out, const Audit& audit, Colour colour);
void print_audit_json(std::ostream& out, const Audit& audit);

}  // namespace takt
