#pragma once
#include <string>

namespace takt {

/// Tells why a bus could not be opened: what failed and what to try.
struct BusError {
  std::string message;
  int error = 0;  ///< errno
};

}  // namespace takt
