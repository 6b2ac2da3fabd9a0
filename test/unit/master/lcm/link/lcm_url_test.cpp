#include "master/lcm/link/lcm_url.hpp"

#include <gtest/gtest.h>

namespace takt {
namespace {

TEST(LcmUrl, PartsAreRead) {
  const auto udpm = parse_lcm_url("udpm://239.255.76.67:7667?ttl=0");
  ASSERT_TRUE(udpm);
  EXPECT_EQ(udpm->scheme, "udpm");
  EXPECT_EQ(udpm->address, "239.255.76.67");
  EXPECT_EQ(udpm->port, 7667);

  const auto tcpq = parse_lcm_url("tcpq://:7701");
  ASSERT_TRUE(tcpq);
  EXPECT_EQ(tcpq->address, "127.0.0.1");
  EXPECT_EQ(tcpq->port, 7701);
  EXPECT_EQ(parse_lcm_url("tcpq://")->port, 7700);
  EXPECT_TRUE(parse_lcm_url("memq://"));
}

TEST(LcmUrl, UnicastAddressForMulticastIsExplained) {
  const auto url = parse_lcm_url("udpm://192.168.0.5:7667");

  ASSERT_FALSE(url);
  EXPECT_NE(url.error().find("multicast address"), std::string::npos);
}

TEST(LcmUrl, NonsenseIsRefused) {
  EXPECT_FALSE(parse_lcm_url(""));
  EXPECT_FALSE(parse_lcm_url("udp://1.2.3.4"));
  EXPECT_FALSE(parse_lcm_url("tcpq://127.0.0.1:77000"));
  EXPECT_FALSE(parse_lcm_url("tcpq://127.0.0.1:77x"));
  EXPECT_FALSE(parse_lcm_url("tcpq://nowhere.example:7700"));
}

}  // namespace
}  // namespace takt
