#include "master/gateway/messages.hpp"

namespace takt {

std::string_view text(DecodeFault fault) noexcept {
  switch (fault) {
    case DecodeFault::other_version:
      return "the publisher has another version of this message type";
    case DecodeFault::malformed:
      return "its bytes are damaged";
  }
  return "";
}

}  // namespace takt
