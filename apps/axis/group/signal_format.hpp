#pragma once
#include <takt/signal_t.hpp>

#include "master/units/units.hpp"

namespace takt {

/// Returns how to interpret a value of the image. A description that makes no sense gives raw
/// counts.
ValueFormat format_of(const signal_t& signal);

}  // namespace takt
