#pragma once
#include <cstddef>
#include <cstdint>
#include <takt/image_t.hpp>
#include <takt/layout_t.hpp>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"
#include "master/rt/exchange/process_image.hpp"

namespace takt {

/// Most values in one image_t: any mix of values and stale marks stays below message_bytes.
inline constexpr std::size_t values_a_message = 100;

/// The messages for the image of a cycle. They are kept, so that a cycle allocates nothing.
class ImageMessages {
 public:
  ImageMessages(const BusPlan& plan, std::int64_t session);

  /// Fills the messages. `wall_minus_monotonic` converts the time of SYNC to wall clock time.
  const std::vector<image_t>& fill(const ImageView& image, Time wall_minus_monotonic);

 private:
  std::vector<image_t> parts_;
};

/// Returns true if the image marks the value of this signal as stale.
bool is_stale(const ImageView& image, std::size_t signal) noexcept;

/// Describes the values, with a few signals per message.
std::vector<layout_t> layout_messages(const BusPlan& plan, std::int64_t session);

}  // namespace takt
