#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"
#include "master/core/event_queue.hpp"
#include "master/core/pdo_fields.hpp"
#include "master/core/pdo_status.hpp"
#include "master/core/working_image.hpp"

namespace takt {

/// How the TPDOs of a node are taken.
enum class Reception : std::uint8_t {
  off,        ///< mapping not verified: frames are not ours to read
  early,      ///< taken, but not missed: the node may not be OPERATIONAL so far
  listening,  ///< taken, watched, but no cycle waits for them
  full,       ///< taken, and cycles wait for those that are due
};

/// Received TPDOs -> working image, and the set that is expected in each cycle. A "beat" is one
/// SYNC that was sent; missed periods are no beats. O(1) per frame. Bus thread only.
class PdoInputs {
 public:
  /// Keeps references to the three.
  PdoInputs(const BusPlan& plan, WorkingImage& image, EventQueue& events);

  /// Values that were taken stay, unless it is `off` now or before.
  void set_reception(std::size_t node_index, Reception reception) noexcept;
  Reception reception(std::size_t node_index) const noexcept { return receptions_[node_index]; }

  /// A SYNC went out at `sync`: what is expected now? `heard` is false where it could not be sent.
  void begin(std::uint64_t cycle, Time sync, bool heard = true) noexcept;

  /// False: no TPDO of this bus.
  bool receive(const StampedFrame& stamped) noexcept;

  /// Nothing that is worth waiting for is outstanding.
  bool complete() const noexcept { return outstanding_ == 0; }
  /// PDOs that this beat waits for, or waited for.
  std::uint32_t expected() const noexcept { return expected_; }
  /// Arrival of the newest PDO of this beat that was expected.
  Time last_arrival() const noexcept { return last_arrival_; }

  /// The window of this beat is over: what has not come is missing. Returns how many.
  std::uint32_t close(Time now) noexcept;
  /// Row by row: what happened since forget_marks(), after the image was published.
  std::span<const PdoMark> marks() const noexcept { return marks_; }
  void forget_marks() noexcept {
    for (PdoMark& mark : marks_) mark.flags = 0;
  }

  /// A PDO of this node has arrived since its reception began, and none is overdue.
  bool fresh(SignalIndex signal) const noexcept { return !image_.is_stale(signal); }

  std::size_t size() const noexcept { return rows_.size(); }
  PdoStatus status(std::size_t row) const noexcept;
  static constexpr std::uint16_t no_row = PdoTable::no_row;
  /// The row of a received frame, of an MPDO the one of its object; else no_row.
  std::uint16_t row_of(const Frame& frame) const noexcept;

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(rows_, marks_, receptions_, beat_, cycle_, sync_, sync_before_, last_arrival_, expected_,
          outstanding_);
  }

 private:
  static constexpr std::uint64_t not_due = ~0ULL;
  static constexpr std::uint8_t patience = 3;  ///< misses in a row after which nobody waits

  struct Row {
    std::uint64_t due = not_due;  ///< beat in which it is expected next
    std::uint64_t last_beat = 0;
    Time expires = never;  ///< its deadline, armed by the first frame
    Time window = never;   ///< counted from SYNC; later is late
    std::uint16_t first = 0;
    std::uint16_t count = 0;
    std::uint16_t number = 0;
    std::uint8_t length = 0;
    std::uint8_t node_index = 0;
    std::uint8_t every = 0;  ///< beats between two frames; 0: not cyclic
    std::uint8_t misses = 0;
    Reception reception = Reception::off;  ///< of its node
    bool known = false;                    ///< its phase has been seen
    bool multiplexed = false;              ///< the first row of an MPDO
    bool waited = false;                   ///< the running beat waits for it
    bool stale = true;
    bool odd_length = false;  ///< told once, until a frame of right length comes
    bool was_late = false;    ///< told once, until a frame comes in time
    std::uint32_t missing = 0;
    std::uint32_t late = 0;
    std::uint32_t length_errors = 0;
    std::uint32_t too_long = 0;
    Time deadline{};

    template <class Archive>
    void keep(Archive& state) noexcept {
      state(due, last_beat, expires, window, misses, reception, known, waited, stale, odd_length,
            was_late, missing, late, length_errors, too_long);
    }
  };

  std::uint16_t find_extended(CobId id) const noexcept;
  std::uint16_t find_object(std::uint16_t first, const Frame& frame) const noexcept;
  void accept(Row& row, PdoMark& news, const StampedFrame& stamped) noexcept;
  // Seldom needed: kept out of the path of a frame.
  [[gnu::cold]] bool use_odd_length(std::size_t position, const StampedFrame& stamped) noexcept;
  [[gnu::cold]] bool use_late(std::size_t position, const StampedFrame& stamped) noexcept;
  [[gnu::cold]] void come_back(Row& row, Time when) noexcept;
  void mark(Row& row, bool stale) noexcept;
  void miss(std::size_t position, Time now) noexcept;
  [[gnu::cold]] void tell(EventKind kind, const Row& row, Time now,
                          std::uint32_t detail = 0) noexcept;

  const BusPlan& plan_;
  WorkingImage& image_;
  EventQueue& events_;
  std::vector<FieldProgram> fields_;
  std::vector<Row> rows_;
  std::vector<PdoMark> marks_;
  std::vector<std::uint16_t> extended_;  ///< rows of 29-bit identifiers, ascending identifier
  std::vector<Reception> receptions_;
  Time window_;  ///< of synchronous frames
  std::uint64_t beat_ = 0;
  std::uint64_t cycle_ = 0;
  Time sync_{};
  Time sync_before_{};
  Time last_arrival_{};
  std::uint32_t expected_ = 0;
  std::uint32_t outstanding_ = 0;
};

}  // namespace takt
