#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace takt::test {

/// Keys and section names in lower case. Of two of one name the first counts.
using PlainSection = std::map<std::string, std::string>;
using PlainIni = std::map<std::string, PlainSection>;

/// A device file read in the simplest way, by nothing of eds_parser: a judge of what that reads.
PlainIni read_plain_ini(const std::filesystem::path& path);

/// Section of an object or of a sub-object: [1018], [1018sub1].
struct PlainKey {
  std::uint16_t index = 0;
  std::optional<std::uint8_t> sub;
};
std::optional<PlainKey> plain_key(std::string_view section);

/// A sum of decimal, hexadecimal (0x...) and octal (0...) numbers and $NODEID, modulo 2^64, with
/// the sign that it has. None: it is not so plain.
struct PlainNumber {
  std::uint64_t bits = 0;
  bool negative = false;
};
std::optional<PlainNumber> plain_number(std::string_view text, unsigned node);

/// What the section has under a key, "" where it has nothing.
std::string_view text_of(const PlainSection& section, const std::string& key);

}  // namespace takt::test
