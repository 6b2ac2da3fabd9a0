#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "master/explain/frame/block_text.hpp"
#include "master/wire/frame.hpp"

namespace takt::learn {

/// One SDO transfer of a recording that has ended, successfully or with an abort.
struct SdoTransfer {
  enum class Kind : std::uint8_t { read, write };
  enum class Extent : std::uint8_t {
    whole,
    too_long,  ///< the value is longer than what is kept
    in_parts,  ///< some frames were not recorded
  };
  Kind kind = Kind::read;
  ObjectKey object;
  std::vector<std::uint8_t> value{};
  Extent extent = Extent::whole;  ///< which part of the value is known
  std::optional<std::uint32_t> abort_code{};
};

/// Follows the SDO frames between one server and its client. CiA 301, 7.2.4.3. Its memory is
/// bounded for any frames.
class SdoObserver {
 public:
  /// Longest value of a segmented transfer that is kept, bytes. BlockText keeps less.
  static constexpr std::size_t most_kept = std::size_t{1} << 16U;

  /// Takes a frame of the client. Returns the transfer if this frame ends it.
  std::optional<SdoTransfer> request(const Frame& frame);
  /// Takes a frame of the server. Returns the transfer if this frame ends it.
  std::optional<SdoTransfer> answer(const Frame& frame);

  /// Returns the number of frames of transfers whose beginning is not in the recording.
  std::uint64_t strays() const noexcept { return strays_; }
  /// Returns the number of transfers that another request cut off, because of two clients or lost
  /// frames.
  std::uint64_t cut_off() const noexcept { return cut_off_; }

 private:
  enum class State : std::uint8_t { idle, asked, announced, segments, last_sent };

  void begin(SdoTransfer::Kind kind, ObjectKey object) noexcept;
  void keep(std::span<const std::uint8_t> bytes);
  void download(const Frame& frame);
  std::optional<SdoTransfer> upload(const Frame& frame);
  void sent_segment(const Frame& frame);
  std::optional<SdoTransfer> read_segment(const Frame& frame);
  std::optional<SdoTransfer> aborted(const Frame& frame);
  std::optional<SdoTransfer> finish();
  bool block_request(const Frame& frame);
  std::optional<SdoTransfer> block_end();

  State state_ = State::idle;
  SdoTransfer transfer_{};
  BlockText block_;
  std::uint64_t strays_ = 0;
  std::uint64_t cut_off_ = 0;
};

}  // namespace takt::learn
