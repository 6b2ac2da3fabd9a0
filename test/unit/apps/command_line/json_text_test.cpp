#include "apps/command_line/json_text.hpp"

#include <gtest/gtest.h>

namespace takt {
namespace {

TEST(JsonText, EscapesWhateverATerminalCouldObey) {
  const nlohmann::json text{{"name", "a\x1B[5m\x07\r\x7F\xC2\x9B\xE2\x80\xAE°\xFF"}};

  EXPECT_EQ(json_text(text), R"({"name":"a\u001b[5m\u0007\r\u007f\u009b\u202e\u00b0\ufffd"})");
  EXPECT_EQ(json_text({{"a", 1}}, 1), "{\n \"a\": 1\n}");
}

TEST(JsonText, IsReadAsTheSameText) {
  const nlohmann::json text{{"unit", "°\x1B\x7F"}};

  EXPECT_EQ(nlohmann::json::parse(json_text(text)), text);
}

}  // namespace
}  // namespace takt
