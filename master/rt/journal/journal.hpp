#pragma once
#include <array>
#include <atomic>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "eds_parser/values/time.hpp"
#include "master/core/event.hpp"
#include "master/wire/frame.hpp"

namespace takt {

/// Kinds of journal records. A record is one word with tag and payload, and the further words that
/// the tag demands. The numbers are part of the file format.
enum class Mark : std::uint8_t {
  cycle = 1,      ///< payload: cycle number
  now = 2,        ///< payload: time
  wait = 3,       ///< payload: 1 if a frame can be received
  receive = 4,    ///< payload: number of frames, three words each
  send = 5,       ///< payload: SendPayload; two words for each frame that was offered
  condition = 6,  ///< payload: ConditionPart; the words of the parts that have changed
  /// Payload: number of set points, or 0 if unchanged; time, then three words each.
  set_points = 7,
  request = 8,        ///< payload: number of words
  stop = 9,           ///< the front thread requested the ordered stop
  replies_full = 10,  ///< a reply had to wait
  event = 11,         ///< event_words words
  gap = 12,           ///< an item was too long to be kept
  checkpoint = 13,    ///< payload: number of words; state of the master, see BusLoop::resume
  motion = 14,        ///< payload: number of words; see put_motion()
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

/// One of the two buffers of a Journal. The records lie one behind the other, and new records
/// overwrite the oldest ones. A record is never divided between the end and the beginning of the
/// tape.
class Tape {
 public:
  explicit Tape(std::size_t words) : words_(words) { assert(words >= blocks); }

  /// Returns room for a record of `count` words. Returns nullptr if the record does not fit before
  /// the end of the tape and is longer than a quarter of the tape.
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
  /// Marks that the next record begins a cycle, at which a reader may start.
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
  /// Marks the due checkpoint as handled, whether it is written or not. Returns false if a
  /// checkpoint of `words` words would leave too little room for other records.
  bool begin_checkpoint(std::size_t words) noexcept {
    checkpoint_due_ = false;
    return words < words_.size() / (2 * blocks / blocks_a_checkpoint);
  }

  /// Returns true if the tape still holds all records from the first one on.
  bool whole() const noexcept { return lap_ == 0; }
  /// Returns the records in order. If the tape is not whole, they begin with the record of a cycle.
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
  std::size_t end_of_lap_ = 0;  // words that the previous lap over the tape has used
  std::size_t block_ = blocks;
  bool checkpoint_due_ = true;
  // Position + 1 of the first cycle in each block; 0 means none.
  std::array<std::uint64_t, blocks> begins_{};
};

/// Records everything that decides what the bus thread does, call by call: the answers of the port
/// and the input from the front thread. One of two tapes records while the other may be read;
/// neither side waits. All functions belong to the bus thread except those marked as front side.
class Journal {
 public:
  /// `bytes` is the size of each of the two tapes.
  explicit Journal(std::size_t bytes) : tapes_{Tape{bytes / 8}, Tape{bytes / 8}} {}

  void begin_cycle(std::uint64_t cycle) noexcept {
    if (state_.load(std::memory_order_acquire) == State::wanted) [[unlikely]]
      change();
    tape_->mark_cycle();
    put(Mark::cycle, cycle);
  }
  void put(Mark mark, std::uint64_t payload) noexcept { tape_->put(journal::word(mark, payload)); }
  void put(Mark mark, Time time) noexcept { put(mark, static_cast<std::uint64_t>(time.count())); }
  /// Begins a record with `count` words after its first word, and returns room for these words.
  /// Returns nullptr if the record is too long.
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
  /// Returns room for a checkpoint, or nullptr if the checkpoint is too long for this tape.
  std::uint64_t* checkpoint(std::size_t words) noexcept {
    std::uint64_t* const room =
        tape_->begin_checkpoint(words) ? claim(Mark::checkpoint, words, words) : nullptr;
    if (room != nullptr) ++beginnings_;
    return room;
  }
  /// Returns the number of places at which a replay can begin so far: the beginning of each tape,
  /// and each checkpoint. A value that is recorded only when it changes is recorded again after
  /// each of these places.
  unsigned beginnings() const noexcept { return beginnings_; }

  /// Front side: requests the running tape. At the next cycle, recording continues on the other
  /// tape. The front side must not call this again before give_back().
  void want() noexcept { state_.store(State::wanted, std::memory_order_release); }
  /// Front side: returns the requested tape, for this thread or one that it starts. Returns nullptr
  /// if the tape is not available yet.
  const Tape* wanted() const noexcept {
    if (state_.load(std::memory_order_acquire) != State::changed) return nullptr;
    return &tapes_[1 - running_];
  }
  /// Front side: returns the tape in use, once the bus thread has ended.
  const Tape& last() const noexcept { return *tape_; }
  void give_back() noexcept { state_.store(State::recording, std::memory_order_release); }

 private:
  enum class State : std::uint8_t { recording, wanted, changed };

  void change() noexcept {
    running_ = 1 - running_;
    tape_ = &tapes_[running_];
    tape_->clear();
    ++beginnings_;
    state_.store(State::changed, std::memory_order_release);
  }

  std::array<Tape, 2> tapes_;
  Tape* tape_ = tapes_.data();
  std::size_t running_ = 0;  // constant while the state is `changed`
  unsigned beginnings_ = 1;
  std::atomic<State> state_{State::recording};
};

}  // namespace takt
