#pragma once
#include <string>

#include "eds_parser/table/typed_message.hpp"

namespace takt {

/// A type as lcm-gen reads it; units and objects as comments.
std::string to_lcm(const TypedMessage& message, const BusPlan& plan);

}  // namespace takt
