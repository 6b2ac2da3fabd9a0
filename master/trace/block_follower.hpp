#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "master/wire/frame.hpp"
#include "master/wire/sdo_block_codec.hpp"

namespace takt {

/// Follows one SDO block transfer, so that it distinguishes segments from other frames, and has the
/// value and its CRC at the end. CiA 301, 7.2.4.3.9 and 7.2.4.3.13.
class BlockFollower {
 public:
  enum class Direction : std::uint8_t { download, upload };
  /// The role of a frame in the transfer.
  enum class Part : std::uint8_t {
    initiate,
    accept,  ///< in an upload, the request of the client
    start,
    segment,
    confirm,
    end,
    end_confirm,
    unknown,
  };

  void begin(ObjectKey object, Direction direction) noexcept;
  void stop() noexcept { running_ = false; }
  bool running() const noexcept { return running_; }
  /// Returns true if the next frame of the source is a segment.
  bool in_segments() const noexcept { return running_ && segments_; }
  /// Returns true if the frame can't be the next segment because it begins another transfer to or
  /// from the device. The end of this transfer was then not seen.
  bool is_over(const Frame& frame) const noexcept;
  bool uploads() const noexcept { return direction_ == Direction::upload; }
  ObjectKey object() const noexcept { return object_; }

  /// Takes a frame of the side that sends the data.
  Part from_source(const Frame& frame);
  /// Takes a frame of the side that receives the data.
  Part from_sink(const Frame& frame);

  /// Returns how many segments the newest confirmation asks the source to repeat.
  std::size_t to_repeat() const noexcept { return to_repeat_; }
  /// Returns true if both sides use the CRC.
  bool uses_crc() const noexcept { return crc_used_; }
  /// Returns the CRC of the segments that were seen.
  std::uint16_t crc() const noexcept { return crc_; }
  /// Returns true if some segments are not in the recording.
  bool has_gap() const noexcept { return gap_; }
  /// Returns the value of a transfer that has just ended. It is complete only if has_value().
  std::vector<std::uint8_t> take_value() { return std::move(value_); }
  bool has_value() const noexcept { return whole_ && !value_.empty(); }
  /// Returns true if the recording shows all segments, but the value has more bytes than are kept.
  bool is_too_long() const noexcept { return !whole_ && !gap_; }

 private:
  Part segment(const Frame& frame);
  Part confirm(const Frame& frame);
  Part end(const Frame& frame);
  void lose_track() noexcept;
  void absorb(std::span<const std::uint8_t> bytes);

  bool running_ = false;
  bool segments_ = false;  // true if the source sends segments next
  bool whole_ = true;      // true if value_ holds all data so far
  bool gap_ = false;       // true if some segments were not seen
  Direction direction_ = Direction::download;
  ObjectKey object_;
  bool crc_offered_ = false;
  bool crc_used_ = false;
  std::uint16_t crc_ = 0;
  std::size_t to_repeat_ = 0;
  std::vector<SdoBlockSegment> sub_block_;   // segments of this sub-block that came in sequence
  std::optional<std::uint8_t> last_number_;  // number of the last segment, if in this sub-block
  std::optional<SdoBlockSegment> held_;      // confirmed segment that may be the last one
  std::vector<std::uint8_t> value_;
};

}  // namespace takt
