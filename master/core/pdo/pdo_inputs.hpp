#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"
#include "master/core/event_queue.hpp"
#include "master/core/pdo/pdo_fields.hpp"
#include "master/core/pdo/working_image.hpp"
#include "master/core/pdo_status.hpp"

namespace takt {

/// The way in which the master receives the TPDOs of a node.
enum class Reception : std::uint8_t {
  off,    ///< The mapping is not verified, so frames are ignored.
  early,  ///< Frames are accepted but not supervised, because the node may not be OPERATIONAL yet.
  listening,  ///< Frames are accepted and supervised, but no cycle waits for them.
  full,       ///< Frames are accepted and supervised, and cycles wait for those that are due.
};

/// Writes received TPDOs to the working image and knows which TPDOs are expected in each cycle. A
/// "beat" is one SYNC that was sent; missed periods are no beats. O(1) per frame. Bus thread only.
class PdoInputs {
 public:
  /// Keeps references to the three arguments.
  PdoInputs(const BusPlan& plan, WorkingImage& image, EventQueue& events);

  /// Sets the reception of a node. Values that have arrived stay fresh, unless the reception is or
  /// was `off`.
  void set_reception(std::size_t node_index, Reception reception) noexcept {
    if (receptions_[node_index] != reception) change_reception(node_index, reception);
  }
  Reception reception(std::size_t node_index) const noexcept { return receptions_[node_index]; }

  /// Begins a cycle, whose SYNC was sent at `sync`, and determines the expected TPDOs. `heard` is
  /// false if the SYNC could not be sent; the cycle is then no beat.
  void begin(std::uint64_t cycle, Time sync, bool heard = true) noexcept;

  /// Takes a frame. Returns false if it is no TPDO of this bus.
  bool receive(const StampedFrame& stamped) noexcept;

  /// Returns true if no TPDO that this beat waits for is outstanding.
  bool complete() const noexcept { return outstanding_ == 0; }
  /// Returns the number of TPDOs for which this beat waits or has waited.
  std::uint32_t expected() const noexcept { return expected_; }
  /// Returns the arrival of the newest expected TPDO of this beat.
  Time last_arrival() const noexcept { return last_arrival_; }

  /// Ends the window of this beat; TPDOs that have not come are missing. Returns their number.
  std::uint32_t close(Time now) noexcept;
  /// Returns the marks of each row since forget_marks(), which is called after the image was
  /// published.
  std::span<const PdoMark> marks() const noexcept { return marks_; }
  void forget_marks() noexcept {
    for (PdoMark& mark : marks_) mark.flags = 0;
  }

  /// Returns true if the TPDO of this signal has arrived since its reception began, and is not
  /// overdue.
  bool fresh(SignalIndex signal) const noexcept { return !image_.is_stale(signal); }

  std::size_t size() const noexcept { return rows_.size(); }
  /// Returns the status of a TPDO; `row` is the index into PdoTable::tpdos.
  PdoStatus status(std::size_t row) const noexcept;
  static constexpr std::uint16_t no_row = PdoTable::no_row;
  /// Returns the row of a received frame; for an MPDO, the row of its object. no_row if there is
  /// none.
  std::uint16_t row_of(const Frame& frame) const noexcept;

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(rows_, marks_, receptions_, beat_, cycle_, sync_, sync_before_, last_arrival_, expected_,
          outstanding_);
  }

 private:
  static constexpr std::uint64_t not_due = ~0ULL;
  static constexpr std::uint8_t waited_misses = 3;  ///< misses in a row after which no cycle waits

  struct Row {
    std::uint64_t due = not_due;  ///< beat in which the TPDO is expected next
    std::uint64_t last_beat = 0;
    Time expires = never;  ///< time at which the deadline is over; the first frame starts it
    Time window = never;   ///< time after SYNC after which a frame counts as late
    std::uint16_t first = 0;
    std::uint16_t count = 0;
    std::uint16_t number = 0;
    std::uint8_t length = 0;
    std::uint8_t node_index = 0;
    std::uint8_t every = 0;  ///< beats between two frames; 0 means not cyclic
    std::uint8_t misses = 0;
    Reception reception = Reception::off;  ///< reception of its node
    bool known = false;                    ///< its phase is known
    bool multiplexed = false;              ///< the first row of an MPDO
    bool waited = false;                   ///< the current beat waits for it
    bool stale = true;
    bool odd_length = false;  ///< reported; reset by a frame of the right length
    bool was_late = false;    ///< reported; reset by a frame in time
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

  void change_reception(std::size_t node_index, Reception reception) noexcept;
  std::uint16_t find_extended(CobId id) const noexcept;
  std::uint16_t find_object(std::uint16_t first, const Frame& frame) const noexcept;
  void accept(Row& row, PdoMark& mark, const StampedFrame& stamped) noexcept;
  // These functions are rarely needed and are kept out of the path of a frame.
  [[gnu::cold]] bool use_odd_length(std::size_t position, const StampedFrame& stamped) noexcept;
  [[gnu::cold]] bool use_late(std::size_t position, const StampedFrame& stamped) noexcept;
  [[gnu::cold]] void come_back(Row& row, Time when) noexcept;
  void mark(Row& row, bool stale) noexcept;
  void miss(std::size_t position, Time now) noexcept;
  [[gnu::cold]] void announce(EventKind kind, const Row& row, Time now,
                              std::uint32_t detail = 0) noexcept;

  const BusPlan& plan_;
  WorkingImage& image_;
  EventQueue& events_;
  std::vector<FieldProgram> fields_;
  std::vector<Row> rows_;
  std::vector<PdoMark> marks_;
  /// Rows with 29-bit identifiers, in ascending order of the identifier.
  std::vector<std::uint16_t> extended_;
  std::vector<Reception> receptions_;
  Time window_;  ///< window of synchronous frames
  std::uint64_t beat_ = 0;
  std::uint64_t cycle_ = 0;
  Time sync_{};
  Time sync_before_{};
  Time last_arrival_{};
  std::uint32_t expected_ = 0;
  std::uint32_t outstanding_ = 0;
};

}  // namespace takt
