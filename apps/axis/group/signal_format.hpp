#pragma once
#include <takt/signal_t.hpp>

#include "master/units/units.hpp"

namespace takt {

/// Returns how to interpret a value of the image. If the description is invalid, the value is
/// interpreted as raw counts.
ValueFormat format_of(const signal_t& signal);

}  // namespace takt
