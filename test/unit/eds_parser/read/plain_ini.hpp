#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace takt::test {

/// Keys and section names are in lower case. If a name occurs twice, the first one counts.
using PlainSection = std::map<std::string, std::string>;
using PlainIni = std::map<std::string, PlainSection>;

/// Reads a device file in the simplest way without any code of eds_parser. The result is the
/// reference for eds_parser.
PlainIni read_plain_ini(const std::filesystem::path& path);

/// The object or sub-object that a section name stands for: [1018], [1018sub1].
struct PlainKey {
  std::uint16_t index = 0;
  std::optional<std::uint8_t> sub;
};
std::optional<PlainKey> plain_key(std::string_view section);

/// A sum of decimal, hexadecimal (0x...) and octal (0...) numbers and $NODEID, modulo 2^64, with
/// its sign. The reader returns std::nullopt for any other text.
struct PlainNumber {
  std::uint64_t bits = 0;
  bool negative = false;
};
std::optional<PlainNumber> plain_number(std::string_view text, unsigned node);

/// Returns the text of a key in a section, or "" if the key is missing.
std::string_view text_of(const PlainSection& section, const std::string& key);

}  // namespace takt::test
