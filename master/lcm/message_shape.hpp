#pragma once
#include <cstddef>
#include <span>
#include <string_view>

namespace takt {

/// Returns true if `body` is exactly an LCM message of this shape. This check runs before the
/// generated decoders, because they trust the sizes in a message. The cost is linear in the size of
/// `body`.
///
/// Shape: `b h i l` are integers of 1, 2, 4 and 8 bytes, `f d` floats, `s` a string, `n` a count
/// (int32). `(...)` repeats the part in parentheses as often as the last count of the same level
/// says.
bool has_shape(std::span<const std::byte> body, std::string_view shape) noexcept;

}  // namespace takt
