#pragma once
#include "master/core/event.hpp"
#include "master/core/request.hpp"
#include "master/rt/exchange/process_image.hpp"

namespace takt {

/// Another user of the master beside LCM: it submits requests and receives images, events and
/// replies. All calls come from the front thread.
class FrontGuest {
 public:
  /// This bit marks the ids of a guest's requests. The ids of LCM requests do not have it.
  static constexpr std::uint64_t mark = std::uint64_t{1} << 62;

  virtual ~FrontGuest() = default;
  /// Takes the reply to one of its requests.
  virtual void take(const Reply& reply) = 0;
  virtual void hear(const Event& event) = 0;
  /// Takes each image, which is valid during the call.
  virtual void see(const ImageView& image) = 0;
};

}  // namespace takt
