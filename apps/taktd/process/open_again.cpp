#include "apps/taktd/process/open_again.hpp"

#include <fcntl.h>
#include <string>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace takt {
namespace {

bool is_pipe(int fd) noexcept {
  struct stat status{};
  return ::fstat(fd, &status) == 0 && S_ISFIFO(status.st_mode);
}

/// Returns true if both descriptors are the same terminal. Opening the master side of a
/// pseudo-terminal creates a new pair instead.
bool is_same_terminal(int one, int other) noexcept {
  unsigned number = 0;
  unsigned other_number = 0;
  return ::ioctl(one, TIOCGDEV, &number) == 0 && ::ioctl(other, TIOCGDEV, &other_number) == 0 &&
         number == other_number;
}

}  // namespace

FileDescriptor open_again(int fd) noexcept {
  const bool pipe = is_pipe(fd);
  if (pipe || ::isatty(fd) != 0) {
    const std::string path = "/proc/self/fd/" + std::to_string(fd);
    FileDescriptor again{::open(path.c_str(), O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC)};
    if (again && (pipe || is_same_terminal(fd, again.get()))) return again;
  }
  return FileDescriptor{::fcntl(fd, F_DUPFD_CLOEXEC, 3)};
}

}  // namespace takt
