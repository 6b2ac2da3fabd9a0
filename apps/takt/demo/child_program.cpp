#include "apps/takt/demo/child_program.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>

namespace takt {
namespace {

constexpr std::size_t longest_line = 8192;
constexpr int cannot_start = 127;

/// Replaces the process by the program. Runs after fork() in a process that has one thread.
[[noreturn]] void become(const std::vector<std::string>& command,
                         const std::vector<std::string>& without, int output, pid_t parent) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (::getppid() != parent) std::_Exit(cannot_start);  // the parent died before prctl()
  const int nothing = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  ::dup2(nothing, STDIN_FILENO);
  ::dup2(output, STDOUT_FILENO);
  ::dup2(output, STDERR_FILENO);
  for (const std::string& name : without) ::unsetenv(name.c_str());
  std::vector<char*> words;
  for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  ::execv(words[0], words.data());
  std::fprintf(stderr, "%s can't be started: %s\n", words[0], std::strerror(errno));
  std::fflush(stderr);
  std::_Exit(cannot_start);
}

}  // namespace

std::expected<ChildProgram, std::string> ChildProgram::start(
    const std::vector<std::string>& command, const std::vector<std::string>& without) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
    return std::unexpected{command.front() + " can't be started: " + std::strerror(errno)};
  }
  FileDescriptor reading{ends[0]};
  const FileDescriptor writing{ends[1]};
  ::fcntl(reading.get(), F_SETFL, O_NONBLOCK);
  std::fflush(nullptr);  // otherwise the child could print what this program has not printed yet
  const pid_t parent = ::getpid();
  const pid_t process = ::fork();
  if (process < 0) {
    return std::unexpected{command.front() + " can't be started: " + std::strerror(errno)};
  }
  if (process == 0) become(command, without, writing.get(), parent);
  return ChildProgram{process, std::move(reading)};
}

ChildProgram::ChildProgram(pid_t process, FileDescriptor output) noexcept
    : process_{process}, output_{std::move(output)} {}

ChildProgram::ChildProgram(ChildProgram&& other) noexcept
    : process_{std::exchange(other.process_, 0)},
      output_{std::move(other.output_)},
      begun_{std::move(other.begun_)},
      exit_code_{other.exit_code_} {}

ChildProgram::~ChildProgram() {
  ask_to_end();
  output_.reset();
  wait();
}

void ChildProgram::read(const std::function<void(std::string_view)>& line) {
  std::array<char, 4096> part{};
  for (;;) {
    const ssize_t size = ::read(output_.get(), part.data(), part.size());
    if (size < 0 && errno == EINTR) continue;
    if (size < 0 && errno == EAGAIN) return;
    if (size <= 0) break;
    for (const char letter : std::string_view{part.data(), static_cast<std::size_t>(size)}) {
      if (letter != '\n') begun_ += letter;
      if (letter != '\n' && begun_.size() < longest_line) continue;
      line(begun_);
      begun_.clear();
    }
  }
  if (!begun_.empty()) line(begun_);
  begun_.clear();
  output_.reset();
}

void ChildProgram::ask_to_end() const noexcept {
  if (process_ > 0) ::kill(process_, SIGTERM);
}

int ChildProgram::wait() noexcept {
  if (process_ <= 0) return exit_code_;
  int status = 0;
  while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
  }
  process_ = 0;
  exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return exit_code_;
}

}  // namespace takt
