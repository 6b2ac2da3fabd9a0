#pragma once
#include <cerrno>

namespace takt {

/// Returns true if a file could not be created for a reason that may pass by itself or after a
/// clean-up: a full, read-only or broken disk, too many open files, or too little memory. Any other
/// error indicates a wrong path.
constexpr bool is_transient_error(int error) noexcept {
  return error == ENOSPC || error == EDQUOT || error == EROFS || error == EIO || error == EMFILE ||
         error == ENFILE || error == ENOMEM;
}

}  // namespace takt
