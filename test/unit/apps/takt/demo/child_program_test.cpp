#include "apps/takt/demo/child_program.hpp"

#include <cstdlib>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <stdexcept>
#include <unistd.h>

namespace takt {
namespace {

using testing::ElementsAre;

/// Starts a command of the shell.
ChildProgram shell(const std::string& text, const std::vector<std::string>& without = {}) {
  auto started = ChildProgram::start({"/bin/sh", "-c", text}, without);
  if (!started) throw std::runtime_error{started.error()};
  return std::move(*started);
}

/// Reads until the program has closed its output.
std::vector<std::string> lines_of(ChildProgram& program) {
  std::vector<std::string> lines;
  while (program.output() >= 0) {
    pollfd state{.fd = program.output(), .events = POLLIN, .revents = 0};
    ::poll(&state, 1, -1);
    program.read([&](std::string_view line) { lines.emplace_back(line); });
  }
  return lines;
}

TEST(ChildProgram, PassesOnTheLinesOfBothOutputs) {
  ChildProgram program = shell("echo one; echo two >&2; echo; printf end");
  EXPECT_THAT(lines_of(program), ElementsAre("one", "two", "", "end"));
  EXPECT_EQ(program.wait(), 0);
}

TEST(ChildProgram, EndsWithItsExitCodeOrItsSignal) {
  EXPECT_EQ(shell("exit 6").wait(), 6);
  EXPECT_EQ(shell("kill -KILL $$").wait(), 128 + 9);
}

TEST(ChildProgram, PassesOnALineWithoutEndInParts) {
  ChildProgram program = shell("head -c 20000 /dev/zero | tr '\\0' x");
  const auto lines = lines_of(program);
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[0].size(), 8192u);
  EXPECT_EQ(lines[1].size(), 8192u);
  EXPECT_EQ(lines[2].size(), 20000u - 2 * 8192u);
}

TEST(ChildProgram, HasNoInputAndAProcessGroupOfItsOwn) {
  ChildProgram program = shell("read line || echo no input; cut -d ' ' -f 5 /proc/$$/stat");
  const auto lines = lines_of(program);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0], "no input");
  EXPECT_NE(lines[1], std::to_string(::getpgrp()));
}

TEST(ChildProgram, DoesNotGetTheVariablesThatAreNotItsOwn) {
  ::setenv("TAKT_KEYS", "/secret", 1);
  ChildProgram with = shell("echo ${TAKT_KEYS-none}");
  ChildProgram without = shell("echo ${TAKT_KEYS-none}", {"TAKT_KEYS"});
  ::unsetenv("TAKT_KEYS");
  EXPECT_THAT(lines_of(with), ElementsAre("/secret"));
  EXPECT_THAT(lines_of(without), ElementsAre("none"));
}

TEST(ChildProgram, EndsWhenItIsAskedAndWhenNobodyHoldsIt) {
  ChildProgram program = shell("trap 'echo asked; exit 3' TERM; echo ready; while :; do :; done");
  pollfd state{.fd = program.output(), .events = POLLIN, .revents = 0};
  ::poll(&state, 1, -1);
  program.read([](std::string_view line) { EXPECT_EQ(line, "ready"); });
  program.ask_to_end();
  EXPECT_THAT(lines_of(program), ElementsAre("asked"));
  EXPECT_EQ(program.wait(), 3);
  const ChildProgram forgotten = shell("exec sleep 1000");  // the test ends
}

TEST(ChildProgram, SaysWhyAProgramCannotBeStarted) {
  auto program = ChildProgram::start({"/none/program"}, {});
  ASSERT_TRUE(program);
  EXPECT_THAT(lines_of(*program),
              ElementsAre("/none/program can't be started: No such file or directory"));
  EXPECT_EQ(program->wait(), 127);
}

}  // namespace
}  // namespace takt
