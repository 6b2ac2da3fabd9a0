#pragma once
#include <expected>
#include <memory>
#include <string>
#include <takt/lcm.hpp>
#include <takt/motion.hpp>

namespace takt {

/// The settings with which a program accesses a bus that may have keys.
struct LcmAccess {
  std::string url;            ///< as for open_lcm()
  std::string keys;           ///< path of the key file; empty means no envelopes
  bool check_images = false;  ///< true: messages of taktd without a valid signature are ignored
};

/// Opens LCM. If `check_images` is set, the connection accepts only messages that taktd has signed.
std::expected<std::unique_ptr<Transport>, Obstacle> open_lcm(const LcmAccess& access);

}  // namespace takt
