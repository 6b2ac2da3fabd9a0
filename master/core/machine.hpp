#pragma once
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>

#include "eds_parser/values/time.hpp"
#include "master/wire/frame.hpp"

namespace takt {

/// States whether a frame is answered soon. The bus loop reserves time on the wire for such an
/// answer.
enum class Answer : std::uint8_t {
  /// The frame is answered soon.
  comes,
  by_server,  ///< An SDO server answers, possibly late; the machine waits for its answer.
  none,
  stream,        ///< The device answers with many frames without a pause, so no frame of lower
                 ///< priority gets through meanwhile.
  after_stream,  ///< The frame gets no answer, but the device may still be sending a stream.
};

/// The frames that machines want to send, in their order. The capacity is fixed. Bus thread only.
class Outbox {
 public:
  /// Largest number of frames.
  static constexpr std::size_t capacity = 256;

  /// Limits the outbox to `frames` frames in total: the budget of a cycle.
  void set_limit(std::size_t frames) noexcept { limit_ = frames < capacity ? frames : capacity; }
  std::size_t limit() const noexcept { return limit_; }
  /// Returns the number of frames that the outbox still accepts.
  std::size_t room() const noexcept { return size_ < limit_ ? limit_ - size_ : 0; }

  /// Adds a frame. Returns false if the outbox is full; the machine then has to try again later.
  bool push(const Frame& frame, Answer answer = Answer::comes) noexcept {
    if (room() == 0) return false;
    answers_[size_] = answer;
    frames_[size_++] = frame;
    return true;
  }
  std::span<const Frame> frames() const noexcept { return {frames_.data(), size_}; }
  /// Returns the answers that the frames expect, in the order of frames().
  std::span<const Answer> answers() const noexcept { return {answers_.data(), size_}; }
  bool empty() const noexcept { return size_ == 0; }
  void clear() noexcept { size_ = 0; }

 private:
  std::array<Frame, capacity> frames_{};
  std::array<Answer, capacity> answers_{};
  std::size_t size_ = 0;
  std::size_t limit_ = capacity;
};

/// The deadline of a machine that must be called at once.
inline constexpr Time at_once{};

/// A protocol machine. It receives frames and the present time, and returns frames and the time of
/// its next call. It reads no clock and allocates no memory.
template <class M>
concept Machine = requires(M machine, const M constant, const Frame& frame, Time now, Outbox& out) {
  { machine.on_frame(frame, now, out) } noexcept;
  { machine.on_time(now, out) } noexcept;
  { constant.deadline() } noexcept -> std::same_as<Time>;
};

}  // namespace takt
