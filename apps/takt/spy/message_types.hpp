#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace takt::spy {

/// A member of a message type, as an .lcm file declares it.
struct Member {
  std::string type;  ///< for example "int64_t", "string", or another message type
  std::string name;
  std::vector<std::string> dimensions{};  ///< numbers, or names of earlier members
  std::string comment{};
};

/// Message types by their names, such as "image_t".
using MessageTypes = std::map<std::string, std::vector<Member>, std::less<>>;

/// Reads the structs of .lcm files, with the comments behind their members. Other text is skipped.
MessageTypes parse_types(std::string_view text);

/// The .lcm files of takt, concatenated. The build generates this text.
extern const std::string_view own_definitions;

/// Returns the message types of takt.
const MessageTypes& own_types();

/// Returns the name of the type of takt whose messages begin with this fingerprint, or an empty
/// text.
std::string_view own_type(std::uint64_t fingerprint);

}  // namespace takt::spy
