#include "eds_parser/values/name_of.hpp"

#include <cstdint>
#include <gtest/gtest.h>

namespace takt {
namespace {

enum class Hidden : std::uint8_t { first, second };
constexpr std::string_view names[]{"one", "two"};

// The compiler compares the number of names with the enumerators.
static_assert(is_enumerator<Hidden::second>() && !is_enumerator<Hidden{2}>());
static_assert(name_of(Hidden::first, names) == "one");

TEST(NameOf, AValueThatIsNoEnumeratorHasTheOtherName) {
  EXPECT_EQ(name_of(Hidden::second, names), "two");
  EXPECT_EQ(name_of(Hidden{2}, names), "");
  EXPECT_EQ(name_of(Hidden{200}, names, "unknown"), "unknown");
}

}  // namespace
}  // namespace takt
