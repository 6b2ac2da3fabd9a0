#pragma once
#include <array>
#include <cstdint>
#include <string>

namespace takt {

/// A secret that senders and the daemon share, by the name that envelopes give.
struct EnvelopeKey {
  static constexpr std::size_t bytes = 32;

  std::string name;
  std::array<std::uint8_t, bytes> secret{};
};

}  // namespace takt
