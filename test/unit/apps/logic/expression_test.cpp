#include "apps/logic/expression.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace takt {
namespace {

using ::testing::HasSubstr;

std::string fault(const std::string& text) {
  const auto parsed = parse_expression(text);
  const auto* found = std::get_if<ExpressionFault>(&parsed);
  return found ? std::to_string(found->column) + ": " + found->text : "none";
}

TEST(Expression, PutsOperandsBeforeTheirOperation) {
  const auto parsed = parse_expression("a.b or not c and d >= 0x1F");
  const auto& steps = std::get<Expression>(parsed).steps;
  ASSERT_EQ(steps.size(), 8U);
  EXPECT_EQ(std::get<NameUse>(steps[0]).name, "a.b");
  EXPECT_EQ(std::get<NameUse>(steps[1]).column, 11U);
  EXPECT_EQ(std::get<Operation>(steps[2]), Operation::negate);
  EXPECT_EQ(std::get<double>(steps[4]), 31.0);
  EXPECT_EQ(std::get<Operation>(steps[5]), Operation::at_least);
  EXPECT_EQ(std::get<Operation>(steps[6]), Operation::both);
  EXPECT_EQ(std::get<Operation>(steps[7]), Operation::either);
}

TEST(Expression, SaysWhatIsExpectedAndWhere) {
  EXPECT_EQ(fault(""), "0: the expression ends where a name, a number, `not` or `(` is expected");
  EXPECT_EQ(fault("a b"), "2: `b` where `and`, `or` or the end is expected");
  EXPECT_EQ(fault("a and"),
            "5: the expression ends where a name, a number, `not` or `(` is expected");
  EXPECT_EQ(fault("(a or b"), "7: the expression ends where `)`, `and` or `or` is expected");
  EXPECT_EQ(fault("rising a"), "7: `a` where `(` is expected");
  EXPECT_EQ(fault("a and or b"), "6: `or` where a name or a number is expected");
  EXPECT_THAT(fault("a..b"), HasSubstr("0: `a..b` where a name or a number"));
  EXPECT_THAT(fault("a == == b"), HasSubstr("5: `=` where"));
  EXPECT_THAT(fault("0xZZ"), HasSubstr("0: `0xZZ` where"));
  EXPECT_THAT(fault("1e999"), HasSubstr("0: `1e999` where"));
}

TEST(Expression, HasBounds) {
  const std::string open(1000, '(');
  EXPECT_THAT(fault(open), HasSubstr("nested too deep"));
  std::string inverse;
  for (int i = 0; i < 400; ++i) inverse += "not ";
  EXPECT_THAT(fault(inverse + "a"), HasSubstr("nested too deep"));
  EXPECT_THAT(fault(std::string(100'000, 'a')), HasSubstr("longer than 2000"));
  std::string chain = "a";
  while (chain.size() < 1990) chain += " or a";
  EXPECT_EQ(fault(chain), "none");
}

}  // namespace
}  // namespace takt
