#pragma once
#include <string>

namespace takt {

/// Why a bus could not be opened: who, what, and what to try.
struct BusError {
  std::string message;
  int error = 0;  ///< errno
};

}  // namespace takt
