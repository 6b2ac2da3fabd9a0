#pragma once
#include "eds_parser/values/data_type.hpp"
#include "eds_parser/values/ids.hpp"

namespace takt {

/// Returns the data type that CiA 301 gives to a communication object, or `unknown` if CiA 301 does
/// not define one.
DataType standard_type(ObjectKey key) noexcept;

/// Returns the data type of a DataType code, or `unknown` if CiA 301 does not define the code.
DataType data_type_of(std::uint32_t code) noexcept;

}  // namespace takt
