#pragma once
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>

#include "eds_parser/table/time.hpp"
#include "master/wire/frame.hpp"

namespace takt {

/// Whether somebody answers a frame soon: the bus loop leaves time for it.
enum class Answer : std::uint8_t {
  comes,
  by_server,  ///< of SDO: however late it is, the machine waits for it
  none,
  stream,  ///< many frames one after another: nothing of less priority gets through beside them
  after_stream,  ///< none, to a device that may still be in the middle of one
};

/// Frames that machines want to send, in order; fixed room. Bus thread only.
class Outbox {
 public:
  static constexpr std::size_t capacity = 256;

  /// From now on at most `frames` frames in all; the budget of a cycle.
  void set_limit(std::size_t frames) noexcept { limit_ = frames < capacity ? frames : capacity; }
  std::size_t limit() const noexcept { return limit_; }
  std::size_t room() const noexcept { return size_ < limit_ ? limit_ - size_ : 0; }

  /// False: full; the frame is not taken and the machine has to come back.
  bool push(const Frame& frame, Answer answer = Answer::comes) noexcept {
    if (room() == 0) return false;
    answers_[size_] = answer;
    frames_[size_++] = frame;
    return true;
  }
  std::span<const Frame> frames() const noexcept { return {frames_.data(), size_}; }
  /// In the order of frames().
  std::span<const Answer> answers() const noexcept { return {answers_.data(), size_}; }
  bool empty() const noexcept { return size_ == 0; }
  void clear() noexcept { size_ = 0; }

 private:
  std::array<Frame, capacity> frames_{};
  std::array<Answer, capacity> answers_{};
  std::size_t size_ = 0;
  std::size_t limit_ = capacity;
};

/// The deadline of a machine that has something to do now.
inline constexpr Time at_once{};

/// A protocol machine: takes frames and time, gives frames and the time it wants to be called
/// next. Reads no clock, allocates nothing.
template <class M>
concept Machine = requires(M machine, const M constant, const Frame& frame, Time now, Outbox& out) {
  { machine.on_frame(frame, now, out) } noexcept;
  { machine.on_time(now, out) } noexcept;
  { constant.deadline() } noexcept -> std::same_as<Time>;
};

}  // namespace takt
