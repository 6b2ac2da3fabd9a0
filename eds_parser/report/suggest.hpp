#pragma once
#include <span>
#include <string>
#include <string_view>

namespace takt {

/// Returns the candidate of which `word` is most likely a misspelling. The result is empty if no
/// candidate is similar enough.
std::string_view nearest(std::string_view word, std::span<const std::string_view> candidates);
/// Returns `, did you mean \`baudrate\`?`, or an empty text if no candidate is similar enough.
std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates);

}  // namespace takt
