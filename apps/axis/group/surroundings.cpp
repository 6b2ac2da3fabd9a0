#include "apps/axis/group/surroundings.hpp"

#include <ctime>
#include <utility>

#include "master/lcm/random_number.hpp"

namespace takt {
namespace {

using std::chrono::nanoseconds;

class Machine final : public Surroundings {
 public:
  nanoseconds now() override { return std::chrono::steady_clock::now().time_since_epoch(); }
  nanoseconds wall() override { return std::chrono::system_clock::now().time_since_epoch(); }
  void wait(std::span<pollfd> descriptors, nanoseconds longest) override {
    const auto seconds = std::chrono::floor<std::chrono::seconds>(longest);
    const timespec pause{.tv_sec = seconds.count(), .tv_nsec = (longest - seconds).count()};
    ::ppoll(descriptors.data(), descriptors.size(), &pause, nullptr);
  }
  std::int64_t random_number() override { return takt::random_number(); }
};

Machine machine;
thread_local Surroundings* of_thread = &machine;

}  // namespace

Surroundings& surroundings() noexcept { return *of_thread; }

UseSurroundings::UseSurroundings(Surroundings& others) noexcept
    : before_{std::exchange(of_thread, &others)} {}
UseSurroundings::~UseSurroundings() { of_thread = before_; }

}  // namespace takt
