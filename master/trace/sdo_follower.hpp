#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "master/trace/block_follower.hpp"
#include "master/wire/frame.hpp"

namespace takt {

/// One SDO transfer, as its frames on the bus show it.
struct SeenTransfer {
  enum class Kind : std::uint8_t { read, write };
  enum class Extent : std::uint8_t {
    whole,
    too_long,  ///< The value is longer than what is kept.
    in_parts,  ///< Some frames were not recorded, or came twice.
  };
  Kind kind = Kind::read;
  ObjectKey object;
  std::optional<std::uint32_t> announced{};  ///< announced size of a segmented transfer, in bytes
  std::size_t length = 0;                    ///< bytes in the frames that were seen
  std::vector<std::uint8_t> value{};
  Extent extent = Extent::whole;  ///< the part of the value that is known
  std::optional<std::uint32_t> abort_code{};
};

/// Follows the SDO frames between one server and its client, and sends nothing itself. Its memory
/// is bounded, whatever frames come. CiA 301, 7.2.4.3.
class SdoFollower {
 public:
  /// Longest value of a segmented transfer that is kept, bytes. BlockFollower keeps less.
  static constexpr std::size_t most_kept = std::size_t{1} << 16U;

  /// Takes a frame of the client. Returns the transfer if this frame ends it.
  std::optional<SeenTransfer> request(const Frame& frame);
  /// Takes a frame of the server. Returns the transfer if this frame ends it.
  std::optional<SeenTransfer> answer(const Frame& frame);

  /// Returns the newest transfer. It may have ended.
  const SeenTransfer& transfer() const noexcept { return transfer_; }
  /// Returns the role of the newest frame in a block transfer. Returns std::nullopt if the frame
  /// belongs to no block transfer.
  std::optional<BlockFollower::Part> block_part() const noexcept { return newest_.part; }
  /// Returns the newest block transfer.
  const BlockFollower& block() const noexcept { return block_; }
  /// Returns true if the beginning of the transfer of the newest frame was not seen.
  bool is_stray() const noexcept { return newest_.stray; }
  /// Returns true if the toggle bit of the newest frame, a segment or its confirmation, does not
  /// alternate.
  bool repeats_toggle() const noexcept { return newest_.repeats_toggle; }
  /// Returns true if the server has accepted a segmented transfer, and segments follow.
  bool expects_segments() const noexcept { return state_ == State::segments; }

  /// Returns the number of frames of transfers whose beginning is not in the recording.
  std::uint64_t strays() const noexcept { return strays_; }
  /// Returns the number of transfers that another request cut off, because of two clients or lost
  /// frames.
  std::uint64_t cut_off() const noexcept { return cut_off_; }

 private:
  enum class State : std::uint8_t { idle, asked, announced, segments, last_sent };
  enum class Side : std::uint8_t { client, server };
  /// Properties of the newest frame.
  struct Newest {
    std::optional<BlockFollower::Part> part{};
    bool stray = false;
    bool repeats_toggle = false;
  };

  std::optional<SeenTransfer> stray() noexcept;
  void begin(SeenTransfer::Kind kind, ObjectKey object) noexcept;
  void keep(std::span<const std::uint8_t> bytes);
  void begin_download(const Frame& frame);
  std::optional<SeenTransfer> begin_upload(const Frame& frame);
  std::optional<SeenTransfer> take_segment(const Frame& frame, SeenTransfer::Kind kind);
  std::optional<SeenTransfer> confirm_segment(const Frame& frame);
  std::optional<SeenTransfer> take_block_frame(const Frame& frame, Side sender);
  std::optional<SeenTransfer> abort(const Frame& frame);
  std::optional<SeenTransfer> finish();
  bool is_in_segments(SeenTransfer::Kind kind) const noexcept;
  void check_toggle(std::optional<bool>& last, const Frame& frame) noexcept;

  State state_ = State::idle;
  SeenTransfer transfer_{};
  Newest newest_;
  std::optional<bool> asked_toggle_;     // toggle bit of the client's newest segment frame
  std::optional<bool> answered_toggle_;  // toggle bit of the server's newest segment frame
  BlockFollower block_;
  std::uint64_t strays_ = 0;
  std::uint64_t cut_off_ = 0;
};

}  // namespace takt
