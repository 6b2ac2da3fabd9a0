#pragma once
#include "master/linux/file_descriptor.hpp"

namespace takt {

/// Opens the terminal or the pipe of `fd` a second time, so that a write to it never blocks.
/// O_NONBLOCK belongs to the open file: set on `fd` itself, it would also change the shell and
/// every other program that shares it. Any other file is only duplicated, because it would lose the
/// position that it shares with them. So is one that may not be opened, for example after `su`.
FileDescriptor open_again(int fd) noexcept;

}  // namespace takt
