#include "eds_parser/values/ids.hpp"

#include <array>
#include <cstdio>

namespace takt {

std::string hex(std::uint32_t value, int digits) { return hex64(value, digits); }

std::string hex64(std::uint64_t value, int digits) {
  std::array<char, 24> text{};
  std::snprintf(text.data(), text.size(), "0x%0*llX", digits,
                static_cast<unsigned long long>(value));
  return text.data();
}

std::string to_string(ObjectKey key) {
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "%04X:%02X", key.index, key.sub);
  return text.data();
}

std::string to_string(CobId id) { return hex(id.id(), id.is_extended() ? 8 : 3); }

}  // namespace takt
