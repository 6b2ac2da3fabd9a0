#include "master/gateway/front_round.hpp"

#include <algorithm>
#include <chrono>

namespace takt {
namespace {

constexpr Time fine_pause = std::chrono::microseconds{15};
constexpr Time longest_pause = std::chrono::milliseconds{20};

}  // namespace

Time pause_before_image(Time now, Time next_image) noexcept {
  if (now < next_image) return std::min(next_image - now, longest_pause);
  // A tenth of the present delay: an image then waits at most this much longer.
  return std::clamp((now - next_image) / 10, fine_pause, longest_pause);
}

}  // namespace takt
