#include "test/e2e/process.hpp"

#include <chrono>
#include <cstdlib>
#include <fcntl.h>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <spawn.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <utility>

#include "test/support/time_limit.hpp"

namespace takt::test {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds look_again{5};

}  // namespace

Process::Process(std::vector<std::string> arguments, fs::path output) : output_{std::move(output)} {
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, output_.c_str(),
                                     O_WRONLY | O_CREAT | O_TRUNC | O_APPEND, 0644);
  ::posix_spawn_file_actions_adddup2(&actions, STDERR_FILENO, STDOUT_FILENO);
  const int error =
      ::posix_spawn(&pid_, pointers[0], &actions, nullptr, pointers.data(), ::environ);
  ::posix_spawn_file_actions_destroy(&actions);
  EXPECT_EQ(error, 0) << arguments[0];
}

Process::~Process() {
  if (pid_ > 0) {
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
}

bool Process::stop() const {
  signal(SIGSTOP);
  siginfo_t seen{};
  return ::waitid(P_PID, static_cast<id_t>(pid_), &seen, WSTOPPED) == 0;
}

std::optional<int> Process::wait(const std::function<void()>& meanwhile) {
  const auto until = Clock::now() + time_limit;
  int status = 0;
  while (::waitpid(pid_, &status, WNOHANG) == 0) {
    if (Clock::now() > until) return std::nullopt;
    if (meanwhile) meanwhile();
    std::this_thread::sleep_for(look_again);
  }
  pid_ = -1;
  if (!WIFEXITED(status)) return std::nullopt;
  return WEXITSTATUS(status);
}

std::string Process::output() const { return read_file(output_); }

bool Process::says(const std::string& text) const {
  const auto until = Clock::now() + time_limit;
  while (output().find(text) == std::string::npos) {
    if (Clock::now() > until) return false;
    std::this_thread::sleep_for(look_again);
  }
  return true;
}

Ended run(std::vector<std::string> arguments, const fs::path& folder) {
  Process process{std::move(arguments), folder / "output"};
  const auto exit_code = process.wait();
  return {exit_code, process.output()};
}

bool missed_cycles(const std::string& output) {
  return output.find("its set-points were not sent in several cycles") != output.npos ||
         output.find("SYNC was missing in several periods") != output.npos;
}

std::string read_file(const fs::path& path) {
  std::ifstream file{path};
  return {std::istreambuf_iterator<char>{file}, {}};
}

}  // namespace takt::test
