#pragma once
#include <cstdint>
#include <cstdio>
#include <string>

namespace takt {

/// Formats a value as 0x and sixteen digits.
inline std::string hex64(std::uint64_t value) {
  char text[24];
  std::snprintf(text, sizeof text, "0x%016llX", static_cast<unsigned long long>(value));
  return text;
}

}  // namespace takt
