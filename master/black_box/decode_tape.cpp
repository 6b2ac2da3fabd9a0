#include "master/black_box/decode_tape.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <numeric>
#include <span>
#include <utility>

#include "master/core/set_point.hpp"
#include "master/rt/journal/recorded_port.hpp"

namespace takt {
namespace {

template <class T>
T read_as(std::span<const std::uint64_t> words) {
  T item;
  std::memcpy(static_cast<void*>(&item), words.data(), sizeof item);
  return item;
}

class TapeDecoder {
 public:
  explicit TapeDecoder(const std::vector<std::uint64_t>& records) : rest_{records} {}

  DecodedTape run() {
    while (!rest_.empty()) record();
    sort_frames();
    return std::move(tape_);
  }

 private:
  std::span<const std::uint64_t> take(std::size_t count) {
    const auto words = rest_.first(std::min(count, rest_.size()));
    rest_ = rest_.subspan(words.size());
    return words;
  }

  void record() {
    const std::uint64_t word = take(1)[0];
    const std::uint64_t payload = journal::payload_of(word);
    tape_.words.push_back(word);
    switch (journal::mark_of(word)) {
      case Mark::now:
        now_ = Time{static_cast<std::int64_t>(payload)};
        break;
      case Mark::receive:
        for (std::uint64_t i = 0; i < payload; ++i) receive();
        break;
      case Mark::send:
        send(journal::SendPayload::of(payload));
        break;
      case Mark::condition:
        condition(payload);
        break;
      case Mark::set_points:
        keep(payload == 0 ? 0 : 1 + payload * sizeof(SetPoint) / 8);
        break;
      case Mark::request:
      case Mark::motion:
      case Mark::checkpoint:
        keep(payload);
        break;
      case Mark::event:
        tape_.events.push_back(read_as<Event>(take(journal::event_words)));
        break;
      default:
        break;
    }
  }

  void keep(std::size_t count) {
    const auto words = take(count);
    tape_.words.insert(tape_.words.end(), words.begin(), words.end());
  }

  void receive() {
    const auto stamped = read_as<StampedFrame>(take(journal::stamped_words));
    tape_.words.push_back(static_cast<std::uint64_t>(stamped.when.count()));
    add({.when = stamped.when, .frame = stamped.frame});
  }

  void send(const journal::SendPayload& payload) {
    for (std::size_t i = 0; i < payload.offered; ++i) {
      const auto frame = read_as<Frame>(take(journal::frame_words));
      if (i < payload.sent) add({.when = now_, .frame = frame});
    }
  }

  void condition(std::uint64_t parts) {
    const std::size_t bits = static_cast<std::size_t>(std::popcount(parts & 3));
    const auto times = rest_.first(std::min(bits, rest_.size()));
    if ((parts & journal::utc) != 0 && !times.empty()) {
      tape_.since_1970 = Time{static_cast<std::int64_t>(times.back())};
    }
    keep(bits + ((parts & journal::state) != 0 ? journal::state_words : 0));
  }

  /// Adds a frame. Its word in the journal gets the number of the frame after all frames are
  /// sorted.
  void add(const LoggedFrame& frame) {
    numbers_.push_back(tape_.words.size());
    tape_.words.push_back(0);
    tape_.frames.push_back(frame);
  }

  void sort_frames() {
    std::vector<std::size_t> order(tape_.frames.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return tape_.frames[i].when; });
    std::vector<LoggedFrame> sorted;
    sorted.reserve(order.size());
    for (const std::size_t i : order) {
      tape_.words[numbers_[i]] = sorted.size();
      sorted.push_back(tape_.frames[i]);
    }
    tape_.frames = std::move(sorted);
  }

  std::span<const std::uint64_t> rest_;
  DecodedTape tape_;
  std::vector<std::size_t> numbers_;  // for each frame, the position of its word in the journal
  Time now_{};
};

}  // namespace

DecodedTape decode_tape(const std::vector<std::uint64_t>& records) {
  return TapeDecoder{records}.run();
}

}  // namespace takt
