#pragma once
#include <cstddef>
#include <span>
#include <string_view>

namespace takt {

/// Whether `body` is, to the byte, an LCM message of this shape. Checked before the generated
/// decoders run, since those take the sizes in a message on trust. Linear in the size of `body`.
///
/// Shape: `b h i l` integers of 1, 2, 4, 8 bytes, `f d` floats, `s` a string, `n` a count (int32),
/// `(...)` the part in parentheses as often as the last count of the same level says.
bool has_shape(std::span<const std::byte> body, std::string_view shape) noexcept;

}  // namespace takt
