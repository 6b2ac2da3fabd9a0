#pragma once
#include <array>
#include <cstdint>
#include <string>

namespace takt {

/// A secret shared by senders and the daemon, with the name that envelopes carry.
struct EnvelopeKey {
  static constexpr std::size_t bytes = 32;

  std::string name;
  std::array<std::uint8_t, bytes> secret{};
};

}  // namespace takt
