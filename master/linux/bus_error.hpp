#pragma once
#include <string>

namespace takt {

/// The reason why a bus could not be opened. The text says what failed and what the user can try.
struct BusError {
  std::string message;
  int error = 0;  ///< errno
};

}  // namespace takt
