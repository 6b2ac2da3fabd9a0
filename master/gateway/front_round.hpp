#pragma once
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <functional>

#include "eds_parser/values/time.hpp"

namespace takt {

/// One round of the front thread. The bus thread does not wake the front thread, so the front
/// thread sleeps until the predicted time of the next image. The order of the three steps keeps the
/// front thread from sleeping past an image. The round reads the prediction before it looks for
/// images. If an image is published between the two steps, either the round finds the image, or the
/// prediction still belongs to that image and the wait ends at once. In the other order, the
/// prediction would already belong to the following image, and the image would wait for a whole
/// period.
struct FrontRound {
  /// Returns the predicted time of the next image; see MasterRun::next_publish().
  std::function<Time()> next_image;
  /// Does everything that can be done now, images included. Returns the latest time of the next
  /// call.
  std::function<Time()> serve;
  /// Waits for work or for the next image.
  std::function<void(Time next_image, Time latest)> wait;

  void run() {
    do {
      step();
    } while (due != Step::predict);
  }
  /// Runs one of the three steps of run(), for a simulation in which time passes between them.
  void step() {
    switch (due) {
      case Step::predict:
        predicted = next_image();
        due = Step::serve;
        return;
      case Step::serve:
        latest = serve();
        due = Step::wait;
        return;
      case Step::wait:
        due = Step::predict;
        // If an image was published meanwhile, this step does not wait: the next round looks for
        // that image. Its predicted time has passed, and after a stall within this round it has
        // passed long ago. wait() would then last too long, see pause_before_image().
        if (next_image() == predicted) wait(predicted, latest);
        return;
    }
  }

  enum class Step : std::uint8_t { predict, serve, wait };
  Step due = Step::predict;
  Time predicted{};
  Time latest{};
};

/// Returns the time to sleep at `now` if the next image is predicted for `next_image`.
inline Time pause_before_image(Time now, Time next_image) noexcept {
  constexpr Time shortest = std::chrono::microseconds{15};
  constexpr Time longest = std::chrono::milliseconds{20};
  if (now < next_image) return std::min(next_image - now, longest);
  // The pause is a tenth of the present delay, so an image waits at most a tenth longer.
  return std::clamp((now - next_image) / 10, shortest, longest);
}

}  // namespace takt
