#pragma once
#include <cerrno>

namespace takt {

/// A file could not be made for a reason that may pass by itself or by somebody who tidies up: a
/// disk that is full, read-only or broken, too many open files. Anything else is a wrong path.
constexpr bool is_passing_trouble(int error) noexcept {
  return error == ENOSPC || error == EDQUOT || error == EROFS || error == EIO || error == EMFILE ||
         error == ENFILE || error == ENOMEM;
}

}  // namespace takt
