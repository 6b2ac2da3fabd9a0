#include <algorithm>
#include <takt/image_input.hpp>
#include <utility>

#include "master/lcm/messages.hpp"

namespace takt {
namespace {

/// Largest number of signals in a layout. It bounds the memory that a layout can make this program
/// allocate.
constexpr std::int32_t most_signals = 65536;
constexpr std::int16_t most_parts = 4096;
/// After this number of unexpected images in sequence, their cycle number is accepted as that of
/// the bus.
constexpr int most_strange = 3;
constexpr std::int64_t second_ns = 1'000'000'000;
constexpr std::int64_t quiet_periods = 20;
constexpr std::int64_t longest_period_ns = 60 * second_ns;
/// A gap of this number of cycles is accepted even if it is longer than a second.
constexpr std::uint64_t least_ahead = 16;

/// Returns the number of cycles from `from` to `to`. `to` must not be smaller than `from`. The
/// difference of any two values fits into the result.
std::uint64_t cycles_between(std::int64_t from, std::int64_t to) noexcept {
  return static_cast<std::uint64_t>(to) - static_cast<std::uint64_t>(from);
}

bool is_range(std::int32_t first, std::int32_t count, std::size_t total) {
  return first >= 0 && count >= 0 &&
         static_cast<std::size_t>(first) + static_cast<std::size_t>(count) <= total;
}

bool is_part(std::int16_t part, std::int16_t parts) {
  return parts >= 1 && parts <= most_parts && part >= 0 && part < parts;
}

}  // namespace

void ImageInput::Parts::restart(std::size_t count) {
  seen.assign(count, 0);
  missing = count;
}

bool ImageInput::Parts::mark(std::size_t part) {
  if (part >= seen.size() || seen[part] != 0) return false;
  seen[part] = 1;
  --missing;
  return true;
}

bool ImageInput::take(const layout_t& part) {
  if (part.schema != message_schema || !is_part(part.part, part.parts)) return false;
  const bool has_period = part.period_ns >= 1 && part.period_ns <= longest_period_ns;
  if (part.total_signals < 1 || part.total_signals > most_signals || !has_period) return false;
  if (has_layout() && part.hash == hash_ && part.session == session_) return false;
  if (session_lives()) return false;
  const auto total = static_cast<std::size_t>(part.total_signals);
  if (part.hash != new_hash_ || part.session != new_session_ || new_signals_.size() != total ||
      layout_parts_.seen.size() != static_cast<std::size_t>(part.parts)) {
    begin(part);
  }
  if (!is_range(part.first_signal, part.num_signals, total) ||
      !layout_parts_.mark(static_cast<std::size_t>(part.part))) {
    return false;
  }
  std::ranges::copy(part.signals, new_signals_.begin() + part.first_signal);
  if (layout_parts_.missing != 0) return false;
  finish();
  return true;
}

void ImageInput::begin(const layout_t& part) {
  new_session_ = part.session;
  new_hash_ = part.hash;
  new_period_ns_ = part.period_ns;
  new_signals_.assign(static_cast<std::size_t>(part.total_signals), {});
  layout_parts_.restart(static_cast<std::size_t>(part.parts));
}

void ImageInput::finish() {
  signals_ = std::exchange(new_signals_, {});
  layout_parts_.restart(0);
  session_ = new_session_;
  hash_ = new_hash_;
  period_ns_ = new_period_ns_;
  has_image_ = false;
  cycle_ = new_cycle_ = -1;
  strange_images_ = 0;
  values_.assign(signals_.size(), 0);
  stale_.assign(signals_.size(), 0);
}

/// Returns true while images of the present session arrive. A layout of another session is then
/// ignored, because it may be forged. If taktd was really restarted, nothing is lost, because it
/// repeats its layout once a second.
bool ImageInput::session_lives() const noexcept {
  return has_image_ && now_ns_ - image_ns_ < std::max(quiet_ns, quiet_periods * period_ns_);
}

bool ImageInput::belongs(const image_t& part) const noexcept {
  return has_layout() && part.schema == message_schema && part.session == session_ &&
         part.layout_hash == hash_ && is_part(part.part, part.parts) &&
         is_range(part.first_signal, part.num_values, signals_.size());
}

/// A gap of up to one second, or of 16 cycles if that is longer, is ordinary. The first image may
/// have any cycle number.
bool ImageInput::is_next(std::int64_t cycle) const noexcept {
  if (cycle <= new_cycle_) return false;
  const auto a_second = static_cast<std::uint64_t>(second_ns / period_ns_);
  return new_cycle_ < 0 || cycles_between(new_cycle_, cycle) <= std::max(a_second, least_ahead);
}

/// Call this for an image that does not follow the newest one. Returns true for the third such
/// image in sequence, if the cycle numbers of the three ascend without large gaps.
bool ImageInput::is_confirmed(std::int64_t cycle) noexcept {
  if (strange_images_ != 0 && cycle == strange_cycle_) return false;  // same image, another part
  const bool follows = strange_images_ != 0 && cycle > strange_cycle_ &&
                       cycles_between(strange_cycle_, cycle) <= least_ahead;
  strange_images_ = follows ? strange_images_ + 1 : 1;
  strange_cycle_ = cycle;
  return strange_images_ >= most_strange;
}

bool ImageInput::take(const image_t& part) {
  if (!belongs(part) || part.cycle < 0) return false;
  if (part.cycle != new_cycle_) {
    if (!is_next(part.cycle) && !is_confirmed(part.cycle)) return false;
    strange_images_ = 0;
    new_cycle_ = part.cycle;
    new_values_.assign(signals_.size(), 0);
    new_stale_.assign(signals_.size(), 0);
    image_parts_.restart(static_cast<std::size_t>(part.parts));
  }
  if (!image_parts_.mark(static_cast<std::size_t>(part.part))) return false;
  std::ranges::copy(part.values, new_values_.begin() + part.first_signal);
  for (const std::int32_t signal : part.stale) {
    if (is_range(signal, 1, signals_.size())) new_stale_[static_cast<std::size_t>(signal)] = 1;
  }
  if (image_parts_.missing != 0) return false;
  values_.swap(new_values_);
  stale_.swap(new_stale_);
  cycle_ = new_cycle_;
  image_ns_ = now_ns_;
  has_image_ = true;
  return true;
}

}  // namespace takt
