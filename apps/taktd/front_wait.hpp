#pragma once
#include <csignal>
#include <poll.h>
#include <vector>

#include "eds_parser/table/time.hpp"

namespace takt {

/// How the front thread waits: for file descriptors, and for images, whose bus thread wakes nobody.
/// It sleeps to the predicted time of the next image and from there looks again every few
/// microseconds, for a while; an image that stays away is looked for more and more rarely.
class FrontWait {
 public:
  explicit FrontWait(const sigset_t* mask);

  /// Returns when something may have to be done: at the latest at `latest`.
  void wait(std::vector<pollfd>& descriptors, Time next_image, Time latest) const;

 private:
  const sigset_t* mask_;
};

}  // namespace takt
