#pragma once
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

  void run() const {
    const Time next = next_image();
    const Time latest = serve();
    // An image was published meanwhile: whether it was found is for the next round to see. Its
    // prediction is over, and after a stall in the middle of this round would be long over.
    if (next_image() == next) wait(next, latest);
  }
};

}  // namespace takt
