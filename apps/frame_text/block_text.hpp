#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "master/wire/frame.hpp"
#include "master/wire/sdo_block_codec.hpp"

namespace takt {

/// Follows one SDO block transfer, so that segments are told from other frames and the end shows
/// the value and whether the CRC is right. CiA 301, 7.2.4.3.9 and 7.2.4.3.13.
class BlockText {
 public:
  enum class Direction : std::uint8_t { download, upload };

  void begin(ObjectKey object, Direction direction) noexcept;
  void stop() noexcept { running_ = false; }
  bool running() const noexcept { return running_; }
  /// The next frame of the source is a segment.
  bool in_segments() const noexcept { return running_ && segments_; }
  /// Segments are awaited, but this is no segment that could come now: it begins a transfer to or
  /// from the device, so the end of this one was not seen.
  bool is_over(const Frame& frame) const noexcept;
  bool uploads() const noexcept { return direction_ == Direction::upload; }
  ObjectKey object() const noexcept { return object_; }

  /// A frame of the side with the data, and of the side that takes them. `name` is the object's.
  std::string from_source(const Frame& frame, const std::string& name);
  std::string from_sink(const Frame& frame, const std::string& name);

  /// The value of a transfer that has just ended; empty where it was too long to be kept.
  std::vector<std::uint8_t> take_value() { return std::move(value_); }
  bool has_value() const noexcept { return whole_ && !value_.empty(); }

 private:
  std::string segment(const Frame& frame, const std::string& name);
  std::string confirm(const Frame& frame);
  std::string end(const Frame& frame, const std::string& name);
  void lose_track() noexcept;
  void absorb(std::span<const std::uint8_t> bytes);
  const char* verb() const noexcept { return uploads() ? "block upload" : "block download"; }

  bool running_ = false;
  bool segments_ = false;  // segments are what comes next from the source
  bool whole_ = true;      // value_ has everything so far
  bool gap_ = false;       // segments were not seen
  Direction direction_ = Direction::download;
  ObjectKey object_;
  bool crc_offered_ = false;
  bool crc_used_ = false;
  std::uint16_t crc_ = 0;
  std::vector<SdoBlockSegment> sub_block_;   // those that came in sequence
  std::optional<std::uint8_t> last_number_;  // of the last segment, in this sub-block
  std::optional<SdoBlockSegment> held_;      // confirmed, but perhaps the last
  std::vector<std::uint8_t> value_;
};

}  // namespace takt
