#pragma once
#include <span>
#include <string>
#include <string_view>

namespace takt {

/// The candidate that `word` is most likely a slip of; empty where none is near enough.
std::string_view nearest(std::string_view word, std::span<const std::string_view> candidates);
/// `, did you mean \`baudrate\`?`, or nothing.
std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates);

}  // namespace takt
