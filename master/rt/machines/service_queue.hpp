#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

#include "master/core/machine.hpp"
#include "master/wire/frame.hpp"
#include "master/wire/wire_time.hpp"

namespace takt {

/// Service frames of the state machines that wait for their turn in the slack. Bus thread only.
class ServiceQueue {
 public:
  /// The state machines write here. If a frame does not fit, they offer it again later.
  Outbox& inbox() noexcept { return outbox_; }
  bool empty() const noexcept { return outbox_.empty(); }
  std::size_t size() const noexcept { return outbox_.frames().size(); }

  bool has(CobId id) const noexcept {
    return std::ranges::find(outbox_.frames(), id, &Frame::id) != outbox_.frames().end();
  }
  std::size_t count(Answer answer) const noexcept {
    return static_cast<std::size_t>(std::ranges::count(outbox_.answers(), answer));
  }
  /// Returns how many of the first `most` frames end within `room`, including their answers. The
  /// count ends with a frame whose answer is a stream (Answer::stream), because no later frame gets
  /// through while the stream runs.
  std::size_t fitting(std::size_t most, Time room, const WireTime& wire) const noexcept {
    Time needed{};
    std::size_t count = 0;
    for (const Answer answer : outbox_.answers().first(std::min(most, size()))) {
      needed += dialogue(answer, wire);
      if (needed > room) break;
      ++count;
      if (answer == Answer::stream) break;
    }
    return count;
  }
  /// Returns the number of frames to SDO servers among the first `most` frames.
  std::size_t to_servers(std::size_t most) const noexcept {
    return static_cast<std::size_t>(
        std::ranges::count_if(outbox_.answers().first(std::min(most, size())), by_server));
  }
  /// Wire time of the frames that do not go to SDO servers, among the first `most`, including their
  /// answers.
  Time to_others(std::size_t most, const WireTime& wire) const noexcept {
    Time sum{};
    for (const Answer answer : outbox_.answers().first(std::min(most, size()))) {
      if (!by_server(answer)) sum += dialogue(answer, wire);
    }
    return sum;
  }
  /// Returns true if none of the first `count` frames gets an answer.
  bool unanswered(std::size_t count) const noexcept {
    return std::ranges::all_of(outbox_.answers().first(std::min(count, size())),
                               [](Answer answer) { return !awaited(answer); });
  }
  std::span<const Frame> first(std::size_t count) const noexcept {
    return outbox_.frames().first(std::min(count, size()));
  }
  /// Removes the first `count` frames, because they were sent.
  void drop(std::size_t count) noexcept {
    const std::size_t kept = size() - count;
    std::copy_n(outbox_.frames().begin() + static_cast<std::ptrdiff_t>(count), kept, rest_.begin());
    std::copy_n(outbox_.answers().begin() + static_cast<std::ptrdiff_t>(count), kept,
                answers_.begin());
    outbox_.clear();
    outbox_.set_limit(Outbox::capacity);
    for (std::size_t i = 0; i < kept; ++i) outbox_.push(rest_[i], answers_[i]);
  }
  void clear() noexcept { outbox_.clear(); }

 private:
  static constexpr bool awaited(Answer answer) noexcept {
    return answer == Answer::comes || by_server(answer);
  }
  static constexpr bool by_server(Answer answer) noexcept {
    return answer == Answer::by_server || answer == Answer::stream;
  }
  static Time dialogue(Answer answer, const WireTime& wire) noexcept {
    return awaited(answer) ? wire.worst_dialogue() : wire.worst_dialogue() / 2;
  }

  Outbox outbox_;
  std::array<Frame, Outbox::capacity> rest_{};
  std::array<Answer, Outbox::capacity> answers_{};
};

}  // namespace takt
