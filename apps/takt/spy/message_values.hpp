#pragma once
#include <expected>
#include <string>
#include <string_view>
#include <vector>

#include "apps/takt/spy/message_types.hpp"
#include "master/lcm/messages.hpp"

namespace takt::spy {

/// One value of a message, for example the name `nodes[2].name` and the text `"elbow"`.
struct Value {
  std::string name;
  std::string text;
  std::string comment;  ///< comment of its member in the .lcm file
};

/// Decodes a message, whose fingerprint is not checked. An array of numbers is one value. The bytes
/// may be anything: the error is a sentence, and the work is limited by the number of bytes.
std::expected<std::vector<Value>, std::string> decode_values(const MessageTypes& types,
                                                             std::string_view type, Bytes bytes);

}  // namespace takt::spy
