#include <algorithm>
#include <bit>
#include <span>

#include "master/black_box/recording_file.hpp"
#include "master/rt/journal/recorded_port.hpp"

namespace takt {
namespace {

using Words = std::span<const std::uint64_t>;

/// Returns the number of words that follow the first word of a record in a file. See Recording.
std::uint64_t length_of(std::uint64_t word) noexcept {
  const std::uint64_t payload = journal::payload_of(word);
  switch (journal::mark_of(word)) {
    case Mark::receive:
      return 2 * payload;
    case Mark::send: {
      const auto send = journal::SendPayload::of(payload);
      return std::min(send.sent, send.offered);
    }
    case Mark::condition: {
      const auto times = static_cast<std::uint64_t>(std::popcount(payload & 3));
      return times + ((payload & journal::state) != 0 ? journal::state_words : 0);
    }
    case Mark::set_points:
      return payload == 0 ? 0 : 1 + payload * sizeof(SetPoint) / 8;
    case Mark::request:
    case Mark::motion:
    case Mark::checkpoint:
      return payload;
    default:
      return 0;
  }
}

/// Number of words and events before the first checkpoint.
struct Before {
  std::size_t words = 0;
  std::size_t events = 0;
  bool found = false;
};

Before before_checkpoint(Words words) noexcept {
  Before before;
  while (before.words < words.size()) {
    const std::uint64_t word = words[before.words];
    const std::uint64_t rest = words.size() - before.words - 1;
    const std::uint64_t length = std::min(length_of(word), rest);
    before.found = journal::mark_of(word) == Mark::checkpoint;
    if (before.found) return before;
    before.events += journal::mark_of(word) == Mark::event;
    before.words += 1 + length;
  }
  return before;
}

template <class T>
void drop(std::vector<T>& items, std::size_t count) {
  const auto end = items.begin() + static_cast<std::ptrdiff_t>(std::min(count, items.size()));
  items.erase(items.begin(), end);
}

}  // namespace

bool begin_with_checkpoint(LoadedRecording& recording) {
  std::size_t events = 0;
  for (std::size_t part = 0; part < recording.parts.size(); ++part) {
    std::vector<std::uint64_t>& words = recording.parts[part].words;
    const Before before = before_checkpoint(words);
    events += before.events;
    if (!before.found) continue;
    drop(words, before.words);
    const std::uint64_t length = std::min(length_of(words.front()), words.size() - 1);
    recording.checkpoint.assign(words.begin() + 1,
                                words.begin() + 1 + static_cast<std::ptrdiff_t>(length));
    drop(words, 1 + length);
    drop(recording.parts, part);
    drop(recording.logs, part);
    drop(recording.decisions, events);
    return true;
  }
  return false;
}

}  // namespace takt
