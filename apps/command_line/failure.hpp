#pragma once
#include <cstdint>
#include <expected>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

namespace takt {

/// Exit code: the command line is wrong, or a file cannot be read.
inline constexpr int exit_wrong_use = 2;

/// Ends a command of `takt`: main() prints the sentence, and the program ends with the exit code.
struct Failure : std::runtime_error {
  explicit Failure(const std::string& sentence, int exit_code = 3, std::uint32_t abort = 0)
      : std::runtime_error{sentence}, code{exit_code}, abort_code{abort} {}

  int code;
  std::uint32_t abort_code;  ///< SDO abort code; 0 if the device did not abort a transfer
};

/// Returns the value. Throws a Failure with the sentence of the error if there is none.
template <class Value, class Error>
Value value_or_fail(std::expected<Value, Error> result, int exit_code) {
  if (!result) {
    if constexpr (std::is_convertible_v<Error, std::string>) {
      throw Failure{result.error(), exit_code};
    } else {
      throw Failure{result.error().message, exit_code};
    }
  }
  if constexpr (!std::is_void_v<Value>) return std::move(*result);
}

}  // namespace takt
