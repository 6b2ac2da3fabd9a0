#include "master/gateway/messages.hpp"

namespace takt {

std::string_view text(DecodeFault fault) noexcept {
  switch (fault) {
    case DecodeFault::other_version:
      return "the publisher has another version of this message type";
    case DecodeFault::malformed:
      return "its bytes are damaged";
    case DecodeFault::out_of_range:
      return "it has an infinite number, or one that 64 bits can't hold";
  }
  return "";
}

}  // namespace takt
