#include "apps/axis/group/signal_format.hpp"

#include <cmath>

namespace takt {

ValueFormat format_of(const signal_t& signal) {
  const bool usable = std::isfinite(signal.scale) && signal.scale != 0.0 &&
                      std::isfinite(signal.offset) && signal.bits >= 1 && signal.bits <= 64;
  if (!usable) return {};
  return {.type = static_cast<DataType>(signal.data_type),
          .bits = static_cast<std::uint8_t>(signal.bits),
          .scale = signal.scale,
          .offset = signal.offset};
}

}  // namespace takt
