#pragma once
#include <string_view>

namespace takt {

/// Returns the meaning of a key of a bus.yml in takt. Empty if the key explains itself.
std::string_view key_meaning(std::string_view key) noexcept;

/// Returns the reason why takt does not use a key of other readers. Empty if the finding says
/// enough.
std::string_view why_ignored(std::string_view key) noexcept;

}  // namespace takt
