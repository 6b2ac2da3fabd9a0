#pragma once
#include <string>

#include "eds_parser/lcm/typed_message.hpp"

namespace takt {

/// Returns a message type in the format of lcm-gen. Units and objects are comments.
std::string to_lcm(const TypedMessage& message, const BusPlan& plan);

}  // namespace takt
