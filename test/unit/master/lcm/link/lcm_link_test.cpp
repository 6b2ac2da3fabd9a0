#include "master/lcm/link/lcm_link.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "master/lcm/tcpq/tcpq_broker.hpp"

namespace takt {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

/// A port on loopback that belongs to another program, which uses tcpq.
class LcmLinkTest : public testing::Test {
 protected:
  LcmUrl url() const {
    return {.text = other->url(), .scheme = "tcpq", .address = "127.0.0.1", .port = other->port()};
  }
  /// Serves both sides without waiting, often enough for them to connect.
  void serve(LcmLink& link) {
    for (int i = 0; i < 100; ++i) {
      link.serve([](std::string_view, std::span<const std::byte>) {});
      other->serve([](std::string_view, std::span<const std::byte>) {});
    }
  }
  LcmLink::Say say() {
    return [this](Weight weight, const std::string& sentence) {
      declared.push_back(std::string{name(weight)} + ": " + sentence);
    };
  }

  std::unique_ptr<TcpqBroker> other = TcpqBroker::listen(0).value();
  std::vector<std::string> declared;
};

TEST_F(LcmLinkTest, IsNobodysClientWhereItsOwnHubFindsThePortTaken) {
  LcmLink link{url(), LcmLink::Hub::own, {"LIFT_COMMAND"}, say()};

  serve(link);

  EXPECT_EQ(other->clients(), 0U);
  EXPECT_THAT(link.url(), IsEmpty());
  EXPECT_THAT(declared, ElementsAre(AllOf(StartsWith("warning: "),
                                          HasSubstr(" is used by another program"))));
  EXPECT_FALSE(link.publish("LIFT_IMAGE", {}));
}

TEST_F(LcmLinkTest, IsTheClientOfTheHubThatTheUrlNames) {
  LcmLink link{url(), LcmLink::Hub::named, {"LIFT_COMMAND"}, say()};

  serve(link);

  EXPECT_EQ(link.url(), other->url());
  EXPECT_GE(other->clients(), 1U);
  EXPECT_THAT(declared, ElementsAre("warning: LCM: no hub answers at " + other->url() +
                                    "; taktd keeps trying"));
}

TEST_F(LcmLinkTest, WarnsOfAHubThatOnlyTheEnvironmentNames) {
  LcmLink link{url(), LcmLink::Hub::by_environment, {"LIFT_COMMAND"}, say()};

  serve(link);

  EXPECT_EQ(link.url(), other->url());
  EXPECT_THAT(declared, ElementsAre(AllOf(StartsWith("warning: LCM: "),
                                          HasSubstr(". LCM_DEFAULT_URL names this hub. The"))));
}

}  // namespace
}  // namespace takt
