#include "apps/axis/lcm_access.hpp"

#include <utility>

#include "apps/axis/axes_state.hpp"
#include "master/lcm/envelope/checked_transport.hpp"
#include "master/lcm/envelope/key_file.hpp"

namespace takt {

std::expected<std::unique_ptr<Transport>, Obstacle> open_lcm(const LcmAccess& access) {
  auto lcm = open_lcm(access.url);
  if (!lcm) return obstacle(Obstacle::Kind::no_bus, lcm.error());
  if (!access.check_images) return std::move(*lcm);
  if (access.keys.empty()) {
    return obstacle(Obstacle::Kind::wrong_use, "--check-images needs a key file: --keys FILE");
  }
  auto keys = WatchedKeyFile::open(access.keys);
  if (!keys) return obstacle(Obstacle::Kind::wrong_use, keys.error());
  return std::make_unique<CheckedTransport>(std::move(*lcm), std::move(*keys));
}

}  // namespace takt
