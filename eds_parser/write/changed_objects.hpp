#pragma once
#include <cstdint>
#include <set>

#include "eds_parser/object_dictionary.hpp"

namespace takt {

/// Objects of `before` that `after` lacks or describes as another: access, type, a value, a limit.
/// A type may appear where there was none.
std::set<std::uint16_t> changed_objects(const ObjectDictionary& before,
                                        const ObjectDictionary& after);

}  // namespace takt
