#include "master/lcm/accept_pause.hpp"

#include <cerrno>
#include <cstring>

namespace takt {

std::optional<std::string> AcceptPause::failed(int error, Time now) {
  const bool missing = error == EMFILE || error == ENFILE || error == ENOBUFS || error == ENOMEM;
  if (!missing) return std::nullopt;
  until_ = now + length;
  if (!reported_.allow("accept", now)) return std::nullopt;
  const std::string why = std::strerror(error);
  return "new connections wait: " + why +
         (error == EMFILE ? "; end some programs, or raise the limit (ulimit -n, LimitNOFILE=)"
                          : "");
}

}  // namespace takt
