#pragma once
#include <cstdint>

#include "master/core/event.hpp"
#include "master/wire/sdo_abort.hpp"

namespace takt {

/// The consequence of a server's frame for a transfer.
struct SdoStep {
  enum class Kind : std::uint8_t {
    stranger,  ///< The frame belongs to an earlier transfer and is ignored.
    goes_on,
    done,
    plain,  ///< The server has switched from a block upload to a segmented or expedited upload.
    abort,  ///< The transfer can't go on; `abort_code` is to be sent.
  };
  Kind kind = Kind::stranger;
  SdoFault fault = SdoFault::aborted_by_master;
  std::uint32_t abort_code = 0;
};

/// Returns the abort after an answer of the server that breaks the protocol.
constexpr SdoStep violation(std::uint32_t code) noexcept {
  return {.kind = SdoStep::Kind::abort, .abort_code = code};
}

/// Returns the abort for a value that does not fit into the buffer of the caller.
constexpr SdoStep exceeds_buffer() noexcept {
  return {.kind = SdoStep::Kind::abort,
          .fault = SdoFault::too_long,
          .abort_code = abort_code::out_of_memory};
}

}  // namespace takt
