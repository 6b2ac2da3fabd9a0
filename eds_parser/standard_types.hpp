#pragma once
#include "eds_parser/table/data_type.hpp"
#include "eds_parser/table/ids.hpp"

namespace takt {

/// Data type that CiA 301 gives to a communication object; unknown where it does not say.
DataType standard_type(ObjectKey key) noexcept;

/// Of a DataType code; `unknown` where CiA 301 has none.
DataType data_type_of(std::uint32_t code) noexcept;

}  // namespace takt
