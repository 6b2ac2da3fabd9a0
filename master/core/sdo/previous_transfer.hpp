#pragma once
#include <cstdint>

#include "eds_parser/values/ids.hpp"
#include "master/core/event.hpp"
#include "master/wire/frame.hpp"

namespace takt {

/// The end of the previous SDO transfer. It decides which frames of the server may still belong to
/// that transfer.
struct PreviousTransfer {
  enum class End : std::uint8_t {
    regular,             ///< No frame of the transfer is outstanding.
    block,               ///< A block transfer has succeeded. If CAN repeats its last frame, the
                         ///< server refuses the repetition.
    violated,            ///< The master has aborted the transfer because of a wrong answer.
    violated_in_block,   ///< As `violated`, in a block upload: its segments may still come.
    abandoned,           ///< The master has aborted the transfer; its answer may still come.
    abandoned_in_block,  ///< As `abandoned`, in a block upload: its segments may still come.
  };
  End end = End::regular;
  ObjectKey object;   ///< valid if the master has aborted the transfer
  Frame last_answer;  ///< CAN may repeat it; a length of 0 means that there is none

  bool aborted_by_master() const noexcept { return end >= End::violated; }
  bool may_be_answered() const noexcept { return end >= End::abandoned; }
  bool may_send_segments() const noexcept {
    return end == End::violated_in_block || end == End::abandoned_in_block;
  }

  /// Returns the end of a transfer that the master aborts.
  static constexpr End end_by_abort(SdoFault fault, bool in_block_upload) noexcept {
    if (fault == SdoFault::aborted_by_master) {
      return in_block_upload ? End::violated_in_block : End::violated;
    }
    return in_block_upload ? End::abandoned_in_block : End::abandoned;
  }
  /// Notes that the server was reset: it sends no segments and refuses no repetition any more.
  void server_was_reset() noexcept {
    if (end == End::block) end = End::regular;
    if (end == End::violated_in_block) end = End::violated;
    if (end == End::abandoned_in_block) end = End::abandoned;
  }

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(end, object);
  }
};

}  // namespace takt
