#pragma once
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace takt::mcap {

/// The bytes with which each file begins and ends.
inline constexpr std::string_view magic{"\x89MCAP0\r\n", 8};

/// First byte of each record.
enum class Opcode : std::uint8_t {
  header = 0x01,
  footer = 0x02,
  schema = 0x03,
  channel = 0x04,
  message = 0x05,
  chunk = 0x06,
  message_index = 0x07,
  chunk_index = 0x08,
  statistics = 0x0B,
  summary_offset = 0x0E,
  data_end = 0x0F,
};

/// Appends a number, least significant byte first.
template <std::unsigned_integral Number>
void put(std::string& out, Number value) {
  for (std::size_t byte = 0; byte < sizeof(Number); ++byte) {
    out.push_back(static_cast<char>(value >> (8 * byte) & 0xFFU));
  }
}

/// Appends the length of a text as 32 bits, and then the text.
inline void put_text(std::string& out, std::string_view text) {
  put(out, static_cast<std::uint32_t>(text.size()));
  out += text;
}

/// Appends a length, and then what is put into `out` during the life of this object. `Length` is
/// the type of the length.
template <std::unsigned_integral Length>
class Counted {
 public:
  explicit Counted(std::string& out) : out_{out} {
    put(out, Length{0});
    begin_ = out.size();
  }
  ~Counted() {
    const auto length = static_cast<Length>(out_.size() - begin_);
    for (std::size_t byte = 0; byte < sizeof(Length); ++byte) {
      out_[begin_ - sizeof(Length) + byte] = static_cast<char>(length >> (8 * byte) & 0xFFU);
    }
  }
  Counted(const Counted&) = delete;
  Counted& operator=(const Counted&) = delete;

 private:
  std::string& out_;
  std::size_t begin_;
};

/// Appends a record, whose content is what is put into `out` during the life of this object.
class Record {
 public:
  Record(std::string& out, Opcode opcode) : content_{(put_opcode(out, opcode), out)} {}

 private:
  static void put_opcode(std::string& out, Opcode opcode) {
    out.push_back(static_cast<char>(opcode));
  }

  Counted<std::uint64_t> content_;
};

}  // namespace takt::mcap
