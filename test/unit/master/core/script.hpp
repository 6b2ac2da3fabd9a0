#pragma once
#include <chrono>
#include <gtest/gtest.h>
#include <initializer_list>
#include <ios>
#include <ostream>
#include <vector>

#include "master/core/machine.hpp"
#include "master/wire/frame.hpp"

namespace takt {

using namespace std::chrono_literals;

inline void PrintTo(const Frame& frame, std::ostream* out) {
  *out << to_string(frame.id) << " [" << int{frame.length} << "]" << std::hex;
  for (std::size_t i = 0; i < frame.length; ++i) *out << ' ' << int{frame.data[i]};
  *out << std::dec;
}

/// Frames as literals: `node5({0x40, 0x18, 0x10, 0x01})` pads to eight bytes.
inline Frame padded(CobId id, std::initializer_list<std::uint8_t> bytes) {
  Frame frame = make_frame(id, bytes);
  frame.length = 8;
  return frame;
}
inline Frame tx(std::initializer_list<std::uint8_t> bytes) {
  return padded(CobId::base(0x605), bytes);
}
inline Frame rx(std::initializer_list<std::uint8_t> bytes) {
  return padded(CobId::base(0x585), bytes);
}
inline Frame nmt(std::initializer_list<std::uint8_t> bytes) {
  return make_frame(CobId::base(0), bytes);
}
inline Frame heartbeat(std::uint8_t state) { return make_frame(CobId::base(0x705), {state}); }

inline std::vector<std::byte> bytes(std::initializer_list<unsigned> values) {
  std::vector<std::byte> out;
  for (const unsigned value : values) out.push_back(static_cast<std::byte>(value));
  return out;
}

}  // namespace takt
