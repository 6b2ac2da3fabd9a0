// judge_many [--cases N] [--seed S] [--class NAME] [--from BLOCK] - plans random tasks of one axis
// and judges the motions: see judge_many.py, which builds and starts it.
#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "test/motion/task_block.hpp"

namespace takt::motion {
namespace {

constexpr std::array<std::string_view, task_classes + 1> class_names{
    "general",     "rest to rest", "to rest",       "near target", "at acceleration",
    "at velocity", "outside",      "round numbers", "wide limits"};

struct Options {
  std::uint64_t cases = 1'000'000;
  std::uint64_t seed = 1;
  std::string_view only;
};

bool read(Options& options, int count, char** words) {
  for (int i = 1; i + 1 < count; i += 2) {
    const std::string_view word = words[i];
    if (word == "--cases") {
      options.cases = std::strtoull(words[i + 1], nullptr, 10);
    } else if (word == "--seed") {
      options.seed = std::strtoull(words[i + 1], nullptr, 10);
    } else if (word == "--class" &&
               std::ranges::find(class_names, words[i + 1]) != class_names.end()) {
      options.only = words[i + 1];
    } else {
      return false;
    }
  }
  return count % 2 == 1 && options.cases > 0;
}

/// The least, the median and the greatest value of many blocks.
class Spread {
 public:
  void add(double value) { values_.push_back(value); }
  void print(const char* what) {
    if (values_.empty()) return;
    std::ranges::sort(values_);
    std::printf("%s: median %.3g, least %.3g, most %.3g\n", what, values_[values_.size() / 2],
                values_.front(), values_.back());
  }

 private:
  std::vector<double> values_;
};

/// Runs the block in child processes, because ruckig crashes at some tasks.
void run_block(TaskClass which, std::uint64_t seed, std::size_t tasks, Seen& seen) {
  seen.next = 0;
  seen.crashed_at_size = 0;
  while (seen.next < tasks) {
    std::fflush(stdout);
    const pid_t child = fork();
    if (child == 0) {
      alarm(600);  // ends a planner that hangs
      TaskBlock{which, seed, tasks, seen}.run();
      std::fflush(stdout);
      _exit(0);
    }
    int status = 0;
    waitpid(child, &status, 0);
    if (status == 0) continue;
    ++seen.crashes;
    if (seen.crashed_at_size == seen.crashed_at.size() || seen.crashes_other(seen.asked)) {
      std::printf("FAILED at a crash outside of ruckig: class %d, seed %llu\n",
                  static_cast<int>(which), static_cast<unsigned long long>(seed));
      ++seen.wrong;
      return;
    }
    seen.crashed_at[seen.crashed_at_size++] = seen.asked;
  }
}

void print_class(std::string_view name, const Seen& seen) {
  std::printf(
      "%-16.*s %llu motions, %llu refused, %llu compared, %llu crashes of ruckig, %llu wrong; "
      "largest end error %.2g, excess %.2g, delay %.2g; %.3f us, ruckig %.3f us\n",
      static_cast<int>(name.size()), name.data(), static_cast<unsigned long long>(seen.tasks),
      static_cast<unsigned long long>(seen.refused), static_cast<unsigned long long>(seen.compared),
      static_cast<unsigned long long>(seen.crashes), static_cast<unsigned long long>(seen.wrong),
      seen.end_error, seen.excess, seen.late,
      1e6 * seen.takt_seconds / static_cast<double>(seen.tasks),
      1e6 * seen.other_seconds / static_cast<double>(seen.tasks));
  std::fflush(stdout);
}

int run(const Options& options, std::span<Seen> seen) {
  std::vector<std::size_t> classes;
  for (std::size_t i = 0; i < class_names.size(); ++i) {
    if (options.only.empty() ? i < task_classes : class_names[i] == options.only) {
      classes.push_back(i);
    }
  }
  const std::uint64_t each = std::max<std::uint64_t>(options.cases / classes.size(), 1);
  Spread takt_cost;
  Spread ratio;
  for (std::uint64_t begin = 0; begin < each; begin += TaskBlock::size) {
    const std::size_t tasks = std::min<std::uint64_t>(TaskBlock::size, each - begin);
    double takt = 0.0;
    double other = 0.0;
    for (const std::size_t i : classes) {
      takt -= seen[i].takt_seconds;
      other -= seen[i].other_seconds;
      const std::uint64_t block = begin / TaskBlock::size;
      run_block(static_cast<TaskClass>(i), (options.seed << 40) + (block << 8) + i, tasks, seen[i]);
      takt += seen[i].takt_seconds;
      other += seen[i].other_seconds;
    }
    takt_cost.add(1e6 * takt / static_cast<double>(tasks * classes.size()));
    if (other > 0.0) ratio.add(other / takt);
    const bool shows = (begin / TaskBlock::size) % 10 == 9;
    if (shows && begin + tasks < each) {
      std::printf("after %llu of %llu:\n",
                  static_cast<unsigned long long>((begin + tasks) * classes.size()),
                  static_cast<unsigned long long>(each * classes.size()));
      for (const std::size_t k : classes) print_class(class_names[k], seen[k]);
    }
  }
  std::printf("all:\n");
  std::uint64_t wrong = 0;
  for (const std::size_t i : classes) {
    print_class(class_names[i], seen[i]);
    wrong += seen[i].wrong;
  }
  takt_cost.print("us an axis, of each block of all classes");
  ratio.print("time of ruckig / time of takt");
  return wrong == 0 ? 0 : 1;
}

}  // namespace
}  // namespace takt::motion

int main(int count, char** words) {
  using namespace takt::motion;
  Options options;
  if (!read(options, count, words)) {
    std::fprintf(stderr, "judge_many [--cases N] [--seed S] [--class NAME]\n");
    return 2;
  }
  constexpr std::size_t size = sizeof(Seen) * class_names.size();
  void* const memory =
      mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) return 2;
  for (std::size_t i = 0; i < class_names.size(); ++i) new (static_cast<Seen*>(memory) + i) Seen;
  return run(options, {static_cast<Seen*>(memory), class_names.size()});
}
