#pragma once
#include "master/core/event.hpp"
#include "master/core/request.hpp"
#include "master/rt/process_image.hpp"

namespace takt {

/// Somebody beside LCM who asks things of the master and hears from it. Front thread.
class FrontGuest {
 public:
  /// In the ids of a guest's requests; those of LCM's have it not.
  static constexpr std::uint64_t mark = std::uint64_t{1} << 62;

  virtual ~FrontGuest() = default;
  /// The answer to one of its requests.
  virtual void take(const Reply& reply) = 0;
  virtual void hear(const Event& event) = 0;
  /// Each image; valid during the call.
  virtual void see(const ImageView& image) = 0;
};

}  // namespace takt
