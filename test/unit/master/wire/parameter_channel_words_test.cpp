#include <gtest/gtest.h>

#include "master/wire/parameter_channel.hpp"

namespace takt {
namespace {

/// The error codes in the manual of the card: invalid command, address, value, operation failed,
/// password, frame, read-only, while running, locked.
TEST(ParameterChannel, ReportsEachErrorCodeInWords) {
  const char* const words[] = {"no error",
                               "invalid command",
                               "no such parameter address",
                               "value out of range",
                               "the operation failed",
                               "wrong password",
                               "the frame is malformed",
                               "the parameter is read-only",
                               "not allowed while the drive is running",
                               "the parameter is locked by a password"};
  for (std::uint16_t code = 0; code < std::size(words); ++code) {
    EXPECT_EQ(parameter_channel::error_text(code), words[code]) << code;
  }
  EXPECT_EQ(parameter_channel::error_text(10), "unknown error code");
}

}  // namespace
}  // namespace takt
