// Counts the images of a running taktd that reach a subscriber later than half a period after SYNC.
// At the same time, a bare loop of clock_nanosleep runs with the same period. The lateness of this
// loop is caused by the machine, not by takt.
//
//   image_delay [SECONDS [LCM_URL]]     60 s, LCM's own URL
#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <thread>
#include <vector>

#include "master/lcm/channel_names.hpp"
#include "master/lcm/link/lcm_client.hpp"
#include "master/lcm/messages.hpp"
#include "master/linux/clock.hpp"

namespace {

using namespace takt;
using namespace std::chrono_literals;

constexpr Time default_period = 2ms;

struct Delays {
  std::vector<Time> all;

  std::size_t later_than(Time limit) const {
    return static_cast<std::size_t>(
        std::ranges::count_if(all, [&](Time delay) { return delay > limit; }));
  }
  Time median() {
    const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
    std::ranges::nth_element(all, middle);
    return *middle;
  }
  void print(const char* name, Time limit) const {
    const std::size_t late = later_than(limit);
    std::printf("%-10s %8zu, %6zu (%.3f %%) later than %.3f ms, longest %.3f ms\n", name,
                all.size(), late,
                100.0 * static_cast<double>(late) / static_cast<double>(all.size()),
                static_cast<double>(limit.count()) / 1e6,
                static_cast<double>(std::ranges::max(all).count()) / 1e6);
  }
};

void bare_loop(const std::atomic<bool>& ends, Delays& delays) {
  for (Time next = monotonic_now(); !ends; next += default_period) {
    sleep_until(next);
    delays.all.push_back(monotonic_now() - next);
    next = std::max(next, monotonic_now() - default_period);  // missed periods are not repeated
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::chrono::seconds time{argc > 1 ? std::atoi(argv[1]) : 60};
  auto lcm = LcmClient::open(argc > 2 ? argv[2] : "", {any_bus("IMAGE")});
  if (!lcm) {
    std::fprintf(stderr, "%s\n", lcm.error().c_str());
    return 1;
  }
  std::atomic<bool> ends{false};
  Delays bare;
  Delays images;
  std::thread loop{[&] { bare_loop(ends, bare); }};
  const Time until = monotonic_now() + time;
  while (monotonic_now() < until) {
    lcm->serve(
        [&](std::string_view, Bytes data) {
          const Time now = monotonic_now();
          const auto image = decode<image_t>(data);
          if (image) images.all.push_back(now - Time{image->sync_mono_ns});
        },
        monotonic_now() + 100ms);
  }
  ends = true;
  loop.join();
  if (images.all.empty()) {
    std::fprintf(stderr, "no image came\n");
    return 1;
  }
  images.print("images", default_period / 2);
  bare.print("bare loop", default_period / 2);
  // An image has some delay even on an idle machine. The loop is compared with what this delay
  // leaves of half a period.
  bare.print("bare loop", default_period / 2 - images.median());
  return 0;
}
