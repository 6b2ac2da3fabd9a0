#pragma once
#include <cstdint>
#include <functional>

#include "eds_parser/table/time.hpp"

namespace takt {

/// One round of the front thread, whose wait is not ended by the bus thread: it sleeps to the
/// predicted time of the next image by itself. The order of the three steps is what keeps it from
/// sleeping over an image. The prediction is read before images are looked for, so an image that is
/// published between the two steps is either found, or the prediction is still the one for that
/// image, and the wait ends at once. In the other order the prediction would already be for the
/// image after it, and the image would lie there for a whole period.
struct FrontRound {
  /// When the next image is predicted to be there; see Master::next_publish().
  std::function<Time()> next_image;
  /// Does everything that can be done now, images included. Returns when it has to be called again
  /// at the latest.
  std::function<Time()> serve;
  /// Waits for work or for the next image.
  std::function<void(Time next_image, Time latest)> wait;

  void run() {
    do {
      step();
    } while (due != Step::predict);
  }
  /// One of the three steps of run(), for a simulation in which time passes between them.
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
        // An image was published meanwhile: whether it was found is for the next round to see. Its
        // prediction is over, and after a stall in the middle of this round would be long over.
        if (next_image() == predicted) wait(predicted, latest);
        return;
    }
  }

  enum class Step : std::uint8_t { predict, serve, wait };
  Step due = Step::predict;
  Time predicted{};
  Time latest{};
};

/// How long to sleep at `now` when the next image is predicted for `next_image`.
Time pause_before_image(Time now, Time next_image) noexcept;

}  // namespace takt
