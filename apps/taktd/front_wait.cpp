#include "apps/taktd/front_wait.hpp"

#include <algorithm>
#include <chrono>
#include <sys/prctl.h>

#include "master/linux/clock.hpp"

namespace takt {
namespace {

constexpr Time fine_pause = std::chrono::microseconds{15};
constexpr Time longest_pause = std::chrono::milliseconds{20};

}  // namespace

Time pause_before_image(Time now, Time next_image) noexcept {
  if (now < next_image) return std::min(next_image - now, longest_pause);
  // A tenth of the delay so far: an image is late by at most that much more.
  return std::clamp((now - next_image) / 10, fine_pause,
                    std::chrono::duration_cast<Time>(longest_pause));
}

FrontWait::FrontWait(const sigset_t* mask) : mask_{mask} {
  ::prctl(PR_SET_TIMERSLACK, 1000UL, 0UL, 0UL, 0UL);  // ns; the default would add 50 us
}

void FrontWait::wait(std::vector<pollfd>& descriptors, Time next_image, Time latest) const {
  const Time now = monotonic_now();
  const Time pause = std::max(Time{0}, std::min(latest - now, pause_before_image(now, next_image)));
  const timespec limit = to_timespec(pause);
  ::ppoll(descriptors.data(), descriptors.size(), &limit, mask_);
}

}  // namespace takt
