#pragma once
#include "master/linux/file_descriptor.hpp"

namespace takt {

/// Opens the terminal or pipe behind `fd` a second time, so that a write to it never blocks.
/// O_NONBLOCK belongs to the open file description: set on `fd` itself, it would also affect the
/// shell and every other program that shares the description. Any other file is only duplicated,
/// because a second description would not share the file position with those programs. A terminal
/// or pipe that this process may not open, for example after `su`, is also only duplicated. So is a
/// socket, which can't be opened.
FileDescriptor open_again(int fd) noexcept;

}  // namespace takt
