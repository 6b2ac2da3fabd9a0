#pragma once
#include <array>
#include <atomic>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "eds_parser/table/time.hpp"
#include "master/core/event.hpp"
#include "master/wire/frame.hpp"

namespace takt {

/// What a record of the journal holds. A record is one word, tag and payload, and the words that
/// the tag demands. Numbers are part of the file format.
enum class Mark : std::uint8_t {
  cycle = 1,          ///< payload: cycle number
  now = 2,            ///< payload: time
  wait = 3,           ///< payload: 1 = a frame can be received
  receive = 4,        ///< payload: frames; three words each
  send = 5,           ///< payload: SendPayload; two words a frame that was offered
  news = 6,           ///< payload: NewsPart; the words of the parts that have changed
  set_points = 7,     ///< payload: how many, 0 = those of before; time, three words each
  request = 8,        ///< payload: words
  stop = 9,           ///< the ordered stop was asked for
  replies_full = 10,  ///< a reply had to wait
  event = 11,         ///< event_words words
  gap = 12,           ///< something was too long to be kept
  checkpoint = 13,    ///< payload: words; what the master knows, see BusLoop::resume
};

namespace journal {

inline constexpr unsigned payload_bits = 56;
inline constexpr std::uint64_t payload_mask = (1ULL << payload_bits) - 1;
inline constexpr std::size_t frame_words = sizeof(Frame) / 8;
inline constexpr std::size_t stamped_words = sizeof(StampedFrame) / 8;
inline constexpr std::size_t event_words = (sizeof(Event) + 7) / 8;
static_assert(sizeof(StampedFrame) == 24);

constexpr std::uint64_t word(Mark mark, std::uint64_t payload) noexcept {
  return static_cast<std::uint64_t>(mark) << payload_bits | (payload & payload_mask);
}
constexpr Mark mark_of(std::uint64_t word) noexcept {
  return static_cast<Mark>(word >> payload_bits);
}
constexpr std::uint64_t payload_of(std::uint64_t word) noexcept { return word & payload_mask; }

}  // namespace journal

/// A stretch of the journal: records one behind the other, the oldest are overwritten. A record is
/// never cut by the end of the tape.
class Tape {
 public:
  explicit Tape(std::size_t words) : words_(words) { assert(words >= blocks); }

  /// Room for a record of `count` words. Null: the tape would have to begin anew for a record
  /// that is longer than a quarter of it.
  std::uint64_t* claim(std::size_t count) noexcept {
    if (at_ + count > words_.size()) [[unlikely]] {
      if (!turn(count)) return nullptr;
    }
    std::uint64_t* const room = words_.data() + at_;
    at_ += count;
    return room;
  }
  void put(std::uint64_t word) noexcept {
    if (std::uint64_t* const room = claim(1)) *room = word;
  }
  /// The next record begins a cycle: one that reading may begin with.
  void mark_cycle() noexcept {
    const std::size_t block = at_ * blocks / words_.size();
    if (block == block_) return;
    block_ = block;
    checkpoint_due_ = checkpoint_due_ || block % blocks_a_checkpoint == 0;
    if (block < blocks) begins_[block] = lap_ * words_.size() + at_ + 1;
  }
  void clear() noexcept {
    at_ = 0;
    lap_ = 0;
    block_ = blocks;
    begins_.fill(0);
    checkpoint_due_ = true;
  }
  bool checkpoint_due() const noexcept { return checkpoint_due_; }
  /// It is made, or can't be. False: a checkpoint of so many words would take the room of all else.
  bool begin_checkpoint(std::size_t words) noexcept {
    checkpoint_due_ = false;
    return words < words_.size() / (2 * blocks / blocks_a_checkpoint);
  }

  /// All records are here, from the first on.
  bool whole() const noexcept { return lap_ == 0; }
  /// The records in order, beginning with that of a cycle where the tape isn't whole.
  std::vector<std::uint64_t> read() const;

 private:
  static constexpr std::size_t blocks = 64;
  static constexpr std::size_t blocks_a_checkpoint = 4;

  bool turn(std::size_t count) noexcept {
    if (count > words_.size() / 4) return false;
    end_of_lap_ = at_;
    at_ = 0;
    ++lap_;
    return true;
  }

  std::vector<std::uint64_t> words_;
  std::size_t at_ = 0;
  std::uint64_t lap_ = 0;
  std::size_t end_of_lap_ = 0;  // of the one before
  std::size_t block_ = blocks;
  bool checkpoint_due_ = true;
  std::array<std::uint64_t, blocks> begins_{};  // position + 1 of the first cycle in each; 0: none
};

/// Everything that decides what the bus thread does, call by call: what the port answered and what
/// came from the front thread. Two tapes: one records, the other may be read meanwhile; nobody
/// waits. Bus thread, but for want() and what follows.
class Journal {
 public:
  /// `bytes` of memory for each of the two tapes.
  explicit Journal(std::size_t bytes) : tapes_{Tape{bytes / 8}, Tape{bytes / 8}} {}

  void begin_cycle(std::uint64_t cycle) noexcept {
    if (state_.load(std::memory_order_acquire) == State::wanted) [[unlikely]]
      change();
    tape_->mark_cycle();
    put(Mark::cycle, cycle);
  }
  void put(Mark mark, std::uint64_t payload) noexcept { tape_->put(journal::word(mark, payload)); }
  void put(Mark mark, Time time) noexcept { put(mark, static_cast<std::uint64_t>(time.count())); }
  /// A record with `count` words behind the first, to be filled; null: too long.
  std::uint64_t* claim(Mark mark, std::uint64_t payload, std::size_t count) noexcept {
    std::uint64_t* const room = tape_->claim(count + 1);
    if (room == nullptr) [[unlikely]] {
      put(Mark::gap, 0);
      return nullptr;
    }
    *room = journal::word(mark, payload);
    return room + 1;
  }
  template <class T>
  void put(Mark mark, std::uint64_t payload, std::span<const T> items) noexcept {
    static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % 8 == 0);
    std::uint64_t* const room = claim(mark, payload, items.size() * sizeof(T) / 8);
    if (room != nullptr && !items.empty()) {
      std::memcpy(static_cast<void*>(room), items.data(), items.size_bytes());
    }
  }
  bool checkpoint_due() const noexcept { return tape_->checkpoint_due(); }
  /// Room for a checkpoint; null: too long for this tape.
  std::uint64_t* checkpoint(std::size_t words) noexcept {
    return tape_->begin_checkpoint(words) ? claim(Mark::checkpoint, words, words) : nullptr;
  }
  /// Counts the tapes that were begun: what has to be told once on each is told again.
  unsigned tape() const noexcept { return tapes_begun_; }

  /// Front side: the running tape is wanted; recording goes on, on the other one, at the next
  /// cycle. Not again before give_back().
  void want() noexcept { state_.store(State::wanted, std::memory_order_release); }
  /// Front side: the wanted tape, for this thread or one that it starts; null: not yet.
  const Tape* wanted() const noexcept {
    if (state_.load(std::memory_order_acquire) != State::changed) return nullptr;
    return &tapes_[1 - running_];
  }
  /// Front side, where the bus thread has ended: the tape that was running.
  const Tape& last() const noexcept { return *tape_; }
  void give_back() noexcept { state_.store(State::recording, std::memory_order_release); }

 private:
  enum class State : std::uint8_t { recording, wanted, changed };

  void change() noexcept {
    running_ = 1 - running_;
    tape_ = &tapes_[running_];
    tape_->clear();
    ++tapes_begun_;
    state_.store(State::changed, std::memory_order_release);
  }

  std::array<Tape, 2> tapes_;
  Tape* tape_ = tapes_.data();
  std::size_t running_ = 0;  // constant while the state is `changed`
  unsigned tapes_begun_ = 1;
  std::atomic<State> state_{State::recording};
};

}  // namespace takt
