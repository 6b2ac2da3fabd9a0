#pragma once
#include <bit>
#include <cstdint>
#include <cstring>
#include <span>

#include "eds_parser/table/pdo_table.hpp"
#include "master/wire/frame.hpp"

namespace takt {

static_assert(std::endian::native == std::endian::little, "frames are read as one word");

/// A PdoField in executable form: two shifts and a mask extract a value from the 64 bits of a
/// frame.
struct FieldProgram {
  std::uint64_t mask = 0;  ///< mask of the value
  SignalIndex signal = 0;
  std::uint8_t left = 0;   ///< shift that brings the highest bit of the field to bit 63
  std::uint8_t right = 0;  ///< shift that then brings its lowest bit to bit 0
};

/// Makes the executable form of a field.
constexpr FieldProgram compile(const PdoField& field) noexcept {
  const std::uint64_t ones = field.bits >= 64 ? ~0ULL : (1ULL << field.bits) - 1;
  return {.mask = field.sign_extend ? ~0ULL : ones,
          .signal = field.signal,
          .left = static_cast<std::uint8_t>(64 - field.bit_offset - field.bits),
          .right = static_cast<std::uint8_t>(64 - field.bits)};
}

/// Returns the eight data bytes of a frame as one word.
inline std::uint64_t load(const Frame& frame) noexcept {
  std::uint64_t word = 0;
  std::memcpy(&word, frame.data.data(), sizeof word);
  return word;
}

/// Writes the eight data bytes of a frame.
inline void store(std::uint64_t word, Frame& frame) noexcept {
  std::memcpy(frame.data.data(), &word, sizeof word);
}

/// Returns the value of one field, with its sign extended if it is signed. CiA 301, 7.1.4.
constexpr std::int64_t take_field(std::uint64_t word, const FieldProgram& field) noexcept {
  const auto top = static_cast<std::int64_t>(word << field.left);
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(top >> field.right) & field.mask);
}

/// Places a value in the bits of its field; all other bits are zero. Higher bits of the value are
/// cut off.
constexpr std::uint64_t put_field(std::int64_t value, const FieldProgram& field) noexcept {
  return (static_cast<std::uint64_t>(value) << field.right) >> field.left;
}

/// Extracts all fields of a frame into the image.
inline void unpack(std::uint64_t word, std::span<const FieldProgram> fields,
                   std::int64_t* image) noexcept {
  for (const FieldProgram& field : fields) image[field.signal] = take_field(word, field);
}

}  // namespace takt
