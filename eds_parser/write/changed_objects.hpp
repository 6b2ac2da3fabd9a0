#pragma once
#include <cstdint>
#include <set>

#include "eds_parser/dictionary/object_dictionary.hpp"

namespace takt {

/// Returns the objects of `before` that `after` lacks or describes differently: in access, type, a
/// value or a limit. A type that `before` does not have is not a difference.
std::set<std::uint16_t> changed_objects(const ObjectDictionary& before,
                                        const ObjectDictionary& after);

}  // namespace takt
