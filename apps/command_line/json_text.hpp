#pragma once
#include <nlohmann/json.hpp>
#include <string>

namespace takt {

inline constexpr int one_line = -1;

/// Returns JSON that is safe for a terminal, in one line or indented by `indent` spaces a level.
/// Everything outside printable ASCII is escaped: control characters (C0, DEL, C1), marks that
/// change the writing direction, and letters of other scripts. Bytes that are not UTF-8 become
/// U+FFFD.
inline std::string json_text(const nlohmann::json& json, int indent = one_line) {
  return json.dump(indent, ' ', true, nlohmann::json::error_handler_t::replace);
}

}  // namespace takt
