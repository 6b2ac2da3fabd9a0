#include "apps/taktd/process/front_wait.hpp"

#include <algorithm>
#include <sys/prctl.h>

#include "master/gateway/front_round.hpp"
#include "master/linux/clock.hpp"

namespace takt {

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
