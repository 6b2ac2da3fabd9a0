#include "master/lcm/envelope/secured_transport.hpp"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <utility>

#include "test/support/folder.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using Octets = std::vector<std::byte>;

class HandClocks final : public Clocks {
 public:
  Time now() const noexcept override { return now_; }
  Time wall_offset() const noexcept override { return 1'700'000'000s; }
  Time wall() const noexcept { return now() + wall_offset(); }
  void pass(Time span) noexcept { now_ += span; }

 private:
  Time now_ = 100s;
};

/// A transport that delivers the messages of a test.
class FakeLcm final : public Transport {
 public:
  bool publish(const std::string& channel, std::span<const std::byte> data) override {
    sent.emplace_back(channel, Octets(data.begin(), data.end()));
    return true;
  }
  void subscribe(const std::string&) override {}
  void serve(const MessageHandler& handler) override {
    for (const auto& [channel, data] : std::exchange(waiting, {})) handler(channel, data);
  }
  void watch(std::vector<pollfd>&) const override {}
  bool good() const override { return true; }
  std::string url() const override { return {}; }

  std::vector<std::pair<std::string, Octets>> waiting;
  std::vector<std::pair<std::string, Octets>> sent;
};

class SecuredTransportTest : public testing::Test {
 protected:
  void write(const std::string& secret) {
    const std::string next = path + ".next";
    std::ofstream{next} << "plant " + secret + "\n";
    ASSERT_EQ(::chmod(next.c_str(), 0600), 0);
    std::filesystem::rename(next, path);
  }
  void bring(const std::string& channel, Bytes data) {
    lcm.waiting.emplace_back(channel, Octets(data.begin(), data.end()));
    secured.serve([this](std::string_view at, Bytes what) {
      heard.push_back(std::string{at} + ":" + std::to_string(what.size()));
    });
  }
  void bring_sealed(const std::string& inner) {
    bring("LIFT_SECURED", seal.seal(inner, message, 42, clocks.wall()));
  }

  const test::Folder folder_;
  const std::string path = folder_ / "lift.keys";
  const Octets message = Octets(5);
  HandClocks clocks;
  FakeLcm lcm;
  std::vector<std::string> heard;
  std::vector<std::string> reported;
  EnvelopeSeal seal{{.name = "plant"}, 7};
  SecuredTransport secured = [this] {
    write(std::string(64, '0'));
    return SecuredTransport{lcm,
                            clocks,
                            WatchedKeyFile::open(path).value(),
                            {.bus = "lift",
                             .session = 42,
                             .guarded = {"LIFT_COMMAND", "LIFT_REQUEST"},
                             .say = [this](const std::string& s) { reported.push_back(s); }}};
  }();
};

TEST_F(SecuredTransportTest, HandsOverWhatIsInGoodEnvelopes) {
  bring_sealed("LIFT_COMMAND");
  bring_sealed("LIFT_REQUEST");
  EXPECT_EQ(heard, (std::vector<std::string>{"LIFT_COMMAND:5", "LIFT_REQUEST:5"}));
  EXPECT_TRUE(reported.empty());
}

TEST_F(SecuredTransportTest, RefusesWhatComesWithoutAnEnvelopeAndReportsItOnceASecond) {
  for (int i = 0; i < 100; ++i) bring("LIFT_COMMAND", message);
  EXPECT_TRUE(heard.empty());
  clocks.pass(1s);
  bring("LIFT_COMMAND", message);
  const std::string sentence =
      "a message on LIFT_COMMAND was refused: this bus has `keys`, and the message came without an "
      "envelope";
  EXPECT_EQ(reported, (std::vector<std::string>{
                          sentence, sentence + " (99 earlier ones were not reported)"}));
}

TEST_F(SecuredTransportTest, ForgedRepeatedAndDelayedEnvelopesChangeNothingAndAreReported) {
  const Bytes first = seal.seal("LIFT_COMMAND", message, 42, clocks.wall());
  const Octets kept(first.begin(), first.end());
  bring("LIFT_SECURED", kept);
  heard.clear();
  Octets altered = kept;
  altered[altered.size() - 33] ^= std::byte{1};

  bring("LIFT_SECURED", kept);
  EXPECT_TRUE(reported.empty()) << "the hub and multicast may both bring it";
  clocks.pass(60ms);
  bring("LIFT_SECURED", altered);
  bring("LIFT_SECURED", kept);
  clocks.pass(2s);
  bring("LIFT_SECURED", kept);
  bring_sealed("LIFT_IMAGE");

  EXPECT_TRUE(heard.empty());
  EXPECT_EQ(reported,
            (std::vector<std::string>{
                "an envelope was refused: its MAC is wrong: it was forged or altered, or its "
                "sender has another secret",
                "an envelope was refused: it is repeated or out of order: the counter of this "
                "sender was higher already",
                "an envelope was refused: its time is more than 1 s in the past",
                "an envelope was refused: taktd accepts no messages on channel 'LIFT_IMAGE'"}));
}

TEST_F(SecuredTransportTest, LetsOtherChannelsThrough) {
  bring("LIFT_OTHER", message);
  EXPECT_EQ(heard, (std::vector<std::string>{"LIFT_OTHER:5"}));
}

TEST_F(SecuredTransportTest, TakesNewKeysWithoutAStop) {
  bring_sealed("LIFT_COMMAND");
  write(std::string(64, '1'));
  clocks.pass(1s);
  bring_sealed("LIFT_COMMAND");

  EXPECT_EQ(heard, (std::vector<std::string>{"LIFT_COMMAND:5"}))
      << "the old secret is good no more";
  ASSERT_EQ(reported.size(), 2U);
  EXPECT_EQ(reported[0], path + " has changed: 1 keys are valid from now on");
}

TEST_F(SecuredTransportTest, SignsNothingThatItPublishesUnlessAsked) {
  secured.publish("LIFT_IMAGE", message);
  ASSERT_EQ(lcm.sent.size(), 1U);
  EXPECT_EQ(lcm.sent[0].first, "LIFT_IMAGE");
}

TEST_F(SecuredTransportTest, PublishesASignedCopyOfEveryMessageWhereThatIsAsked) {
  SecuredTransport signing{lcm,
                           clocks,
                           WatchedKeyFile::open(path).value(),
                           {.bus = "lift", .session = 42, .guarded = {}, .signs = true, .say = {}}};
  signing.publish("LIFT_IMAGE", message);
  signing.publish("LIFT_STATUS", Octets(7));

  ASSERT_EQ(lcm.sent.size(), 4U);
  EXPECT_EQ(lcm.sent[0].first, "LIFT_IMAGE");
  EXPECT_EQ(lcm.sent[1].first, "LIFT_SIGNED");
  EnvelopeGuard guard{std::nullopt};
  guard.set_keys({{.name = "plant"}});
  const auto image = guard.open(lcm.sent[1].second, clocks.wall());
  const auto status = guard.open(lcm.sent[3].second, clocks.wall());
  ASSERT_TRUE(image && status);
  EXPECT_EQ(image->channel, "LIFT_IMAGE");
  EXPECT_EQ(image->session, 42);
  EXPECT_EQ(image->data.size(), 5U);
  EXPECT_EQ(status->channel, "LIFT_STATUS");
}

}  // namespace
}  // namespace takt
