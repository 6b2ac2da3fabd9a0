#include <cstdio>
#include <cstdlib>
#include <gtest/gtest.h>
#include <string>

#include "test/mutation/mutant.hpp"

// Part of each test program of the copy that mutate.py makes. Appends a line to the file
// TAKT_MUTANT_REACH for each test: its name, its time in ms, its verdict, and the mutants that it
// reached. The name of a line of mutants that were reached outside of tests is "-".

namespace {

class ReachListener : public testing::EmptyTestEventListener {
 public:
  explicit ReachListener(const char* path) : file_{std::fopen(path, "a")} {
    if (file_ == nullptr) std::abort();
  }

 private:
  void OnTestStart(const testing::TestInfo& /*test*/) override { write("-", 0, "outside"); }
  void OnTestEnd(const testing::TestInfo& test) override {
    const auto& result = *test.result();
    const char* const verdict =
        result.Passed() ? "passed" : (result.Skipped() ? "skipped" : "failed");
    const auto name = std::string{test.test_suite_name()} + '.' + test.name();
    write(name.c_str(), static_cast<long>(result.elapsed_time()), verdict);
  }
  void OnTestProgramEnd(const testing::UnitTest& /*unit_test*/) override {
    write("-", 0, "outside");
  }

  void write(const char* name, long ms, const char* verdict) {
    std::fprintf(file_, "%s\t%ld\t%s\t", name, ms, verdict);
    for (int number = 0; number < takt_mutation::most; ++number) {
      if (takt_mutation::reached[number].exchange(false)) std::fprintf(file_, "%d ", number);
    }
    std::fprintf(file_, "\n");
    std::fflush(file_);
  }

  std::FILE* file_;
};

const bool listening = [] {
  const char* const path = std::getenv("TAKT_MUTANT_REACH");
  if (path != nullptr) {
    testing::UnitTest::GetInstance()->listeners().Append(new ReachListener{path});
  }
  return path != nullptr;
}();

}  // namespace
