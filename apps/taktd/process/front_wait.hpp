#pragma once
#include <csignal>
#include <poll.h>
#include <vector>

#include "eds_parser/values/time.hpp"

namespace takt {

/// Lets the front thread wait for file descriptors and for images. The bus thread does not wake the
/// front thread, so the front thread sleeps until the predicted time of the next image and then
/// polls every few microseconds. If the image does not come, it polls less and less often.
class FrontWait {
 public:
  explicit FrontWait(const sigset_t* mask);

  /// Returns when there may be work, and no later than `latest`.
  void wait(std::vector<pollfd>& descriptors, Time next_image, Time latest) const;

 private:
  const sigset_t* mask_;
};

}  // namespace takt
