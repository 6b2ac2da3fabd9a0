#pragma once
#include <string>
#include <string_view>

namespace takt {

/// The bus that the argument `--bus` or the key `interface:` names.
struct BusName {
  enum class Kind : unsigned char { simulated, can_interface, unix_path };
  Kind kind = Kind::simulated;
  std::string name{};  ///< interface or path

  /// Reads the name of a bus. An empty text or `sim` is a simulated bus, `unix:PATH` is a unix bus,
  /// and anything else is the name of a CAN interface.
  static BusName parse(std::string_view text) {
    constexpr std::string_view prefix = "unix:";
    if (text.empty() || text == "sim") return {};
    if (text.starts_with(prefix)) {
      return {.kind = Kind::unix_path, .name = std::string{text.substr(prefix.size())}};
    }
    return {.kind = Kind::can_interface, .name = std::string{text}};
  }
};

}  // namespace takt
