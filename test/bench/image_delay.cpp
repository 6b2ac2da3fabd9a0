// How many images of a running taktd reach a subscriber later than half a period after SYNC, beside
// a bare loop of clock_nanosleep with the same period in the same time: what the loop is late by,
// the machine has done to everybody.
//
//   image_delay [SECONDS [LCM_URL]]     60 s, LCM's own URL
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "master/gateway/lcm_client.hpp"
#include "master/gateway/messages.hpp"
#include "master/gateway/names.hpp"
#include "master/linux/clock.hpp"

namespace {

using namespace takt;
using namespace std::chrono_literals;

constexpr Time default_period = 2ms;

struct Lateness {
  long long all = 0;
  long long late = 0;
  Time longest{};

  void take(Time by, Time limit) {
    ++all;
    late += by > limit;
    longest = std::max(longest, by);
  }
  void print(const char* name) const {
    std::printf("%-10s %8lld, %6lld later than half a period (%.3f %%), longest %.3f ms\n", name,
                all, late,
                all == 0 ? 0 : 100.0 * static_cast<double>(late) / static_cast<double>(all),
                static_cast<double>(longest.count()) / 1e6);
  }
};

void bare_loop(const std::atomic<bool>& ends, Lateness& lateness) {
  for (Time next = monotonic_now(); !ends; next += default_period) {
    sleep_until(next);
    lateness.take(monotonic_now() - next, default_period / 2);
    next = std::max(next, monotonic_now() - default_period);  // what was missed is not made up for
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
  Lateness bare;
  Lateness images;
  std::thread loop{[&] { bare_loop(ends, bare); }};
  const Time until = monotonic_now() + time;
  while (monotonic_now() < until) {
    lcm->serve(
        [&](std::string_view, Bytes data) {
          const Time now = monotonic_now();
          const auto image = decode<image_t>(data);
          if (image) images.take(now - Time{image->sync_mono_ns}, default_period / 2);
        },
        monotonic_now() + 100ms);
  }
  ends = true;
  loop.join();
  bare.print("bare loop");
  images.print("images");
  return 0;
}
