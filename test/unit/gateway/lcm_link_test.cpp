#include "master/gateway/lcm_link.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "master/gateway/tcpq_broker.hpp"

namespace takt {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

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
    return [this](const std::string& sentence) { said.push_back(sentence); };
  }

  std::unique_ptr<TcpqBroker> other = TcpqBroker::listen(0).value();
  std::vector<std::string> said;
};

TEST_F(LcmLinkTest, IsNobodysClientWhereItsOwnHubFindsThePortTaken) {
  LcmLink link{url(), true, {"LIFT_COMMAND"}, say()};

  serve(link);

  EXPECT_EQ(other->clients(), 0U);
  EXPECT_THAT(link.url(), IsEmpty());
  EXPECT_THAT(said, ElementsAre(HasSubstr(" is taken by another program")));
  EXPECT_FALSE(link.publish("LIFT_IMAGE", {}));
}

TEST_F(LcmLinkTest, IsTheClientOfTheHubThatTheUrlNames) {
  LcmLink link{url(), false, {"LIFT_COMMAND"}, say()};

  serve(link);

  EXPECT_EQ(link.url(), other->url());
  EXPECT_GE(other->clients(), 1U);
}

}  // namespace
}  // namespace takt
