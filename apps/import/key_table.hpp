#pragma once
#include <string_view>

namespace takt {

/// What a key of a bus.yml becomes here, or why it becomes nothing; empty: the key says it itself.
std::string_view key_meaning(std::string_view key) noexcept;

/// Why a key of other readers is not used; empty: no more than the finding says.
std::string_view why_ignored(std::string_view key) noexcept;

}  // namespace takt
