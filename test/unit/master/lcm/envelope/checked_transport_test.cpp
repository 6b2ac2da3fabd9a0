#include "master/lcm/envelope/checked_transport.hpp"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <utility>

#include "master/lcm/channel_names.hpp"
#include "test/support/folder.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using Octets = std::vector<std::byte>;
using Arriving = std::vector<std::pair<std::string, Octets>>;

class FakeLcm final : public Transport {
 public:
  FakeLcm(Arriving& arriving, std::vector<std::string>& patterns)
      : arriving_{arriving}, patterns_{patterns} {}
  bool publish(const std::string&, std::span<const std::byte>) override { return true; }
  void subscribe(const std::string& pattern) override { patterns_.push_back(pattern); }
  void serve(const MessageHandler& handler) override {
    for (const auto& [channel, data] : std::exchange(arriving_, {})) handler(channel, data);
  }
  void watch(std::vector<pollfd>&) const override {}
  bool good() const override { return true; }
  std::string url() const override { return {}; }

 private:
  Arriving& arriving_;
  std::vector<std::string>& patterns_;
};

/// The messages that reach a program that checks images.
class CheckedTransportTest : public testing::Test {
 protected:
  void SetUp() override {
    checked.subscribe(any_bus("LAYOUT"));
    checked.subscribe("LIFT_IMAGE");
  }
  void write_key(char digit) {
    const std::string next = path + ".next";
    std::ofstream{next} << "plant " + std::string(64, digit) + "\n";
    ASSERT_EQ(::chmod(next.c_str(), 0600), 0);
    std::filesystem::rename(next, path);
  }
  Octets sealed(EnvelopeSeal& by, const std::string& channel, std::uint8_t value) {
    const Octets message{std::byte{value}};
    const Bytes envelope = by.seal(channel, message, 42, now);
    return {envelope.begin(), envelope.end()};
  }
  /// Returns channel and first byte of the messages that are delivered when this one arrives.
  std::string heard(const std::string& channel, const Octets& data) {
    arriving.emplace_back(channel, data);
    std::string all;
    checked.serve([&](std::string_view at, Bytes what) {
      all += std::string{at} + ":" + std::to_string(std::to_integer<int>(what[0]));
    });
    return all;
  }

  const test::Folder folder_;
  const std::string path = folder_ / "lift.keys";
  Time now = 1'700'000'000s;
  Arriving arriving;
  std::vector<std::string> patterns;
  EnvelopeSeal daemon{{.name = "plant"}, 7};
  CheckedTransport checked = [this] {
    write_key('0');
    return CheckedTransport{std::make_unique<FakeLcm>(arriving, patterns),
                            WatchedKeyFile::open(path).value(), [this] { return now; }};
  }();
};

TEST_F(CheckedTransportTest, HearsOnlyTheChannelOfSignedMessages) {
  EXPECT_EQ(patterns, std::vector<std::string>{any_bus("SIGNED")});
}

TEST_F(CheckedTransportTest, HandsOverWhatTheDaemonHasSignedAndTheProgramAskedFor) {
  EXPECT_EQ(heard("LIFT_SIGNED", sealed(daemon, "LIFT_IMAGE", 1)), "LIFT_IMAGE:1");
  EXPECT_EQ(heard("LIFT_SIGNED", sealed(daemon, "LIFT_LAYOUT", 2)), "LIFT_LAYOUT:2");
  EXPECT_EQ(heard("LIFT_SIGNED", sealed(daemon, "LIFT_TIMING", 3)), "");
  EXPECT_EQ(checked.refused(), 0U);
}

TEST_F(CheckedTransportTest, AForgedImageChangesNothing) {
  EnvelopeSeal forger{{.name = "plant", .secret = {1}}, 7};
  EnvelopeSeal stranger{{.name = "other"}, 7};
  EXPECT_EQ(heard("LIFT_IMAGE", Octets(1)), "") << "without an envelope";
  EXPECT_EQ(heard("LIFT_SIGNED", sealed(forger, "LIFT_IMAGE", 1)), "");
  EXPECT_EQ(heard("LIFT_SIGNED", sealed(stranger, "LIFT_IMAGE", 1)), "");
  EXPECT_EQ(heard("LIFT_SIGNED", Octets(300, std::byte{0xEE})), "");
  EXPECT_EQ(heard("LIFT_SECURED", sealed(daemon, "LIFT_IMAGE", 1)), "");
  EXPECT_EQ(checked.refused(), 5U);
}

TEST_F(CheckedTransportTest, AnAlteredImageChangesNothing) {
  const Octets good = sealed(daemon, "LIFT_IMAGE", 1);
  for (std::size_t i = 0; i < good.size(); ++i) {
    Octets altered = good;
    altered[i] ^= std::byte{1};
    EXPECT_EQ(heard("LIFT_SIGNED", altered), "") << "byte " << i;
  }
  EXPECT_EQ(heard("LIFT_SIGNED", good), "LIFT_IMAGE:1");
}

TEST_F(CheckedTransportTest, AReplayedDelayedOrReorderedImageChangesNothing) {
  const Octets first = sealed(daemon, "LIFT_IMAGE", 1);
  const Octets second = sealed(daemon, "LIFT_IMAGE", 2);
  const Octets third = sealed(daemon, "LIFT_IMAGE", 3);
  EXPECT_EQ(heard("LIFT_SIGNED", second), "LIFT_IMAGE:2");
  EXPECT_EQ(heard("LIFT_SIGNED", second), "") << "replayed";
  EXPECT_EQ(heard("LIFT_SIGNED", first), "") << "reordered";
  now += 1001ms;
  EXPECT_EQ(heard("LIFT_SIGNED", third), "") << "delayed";
  EXPECT_EQ(heard("LIFT_SIGNED", sealed(daemon, "LIFT_IMAGE", 4)), "LIFT_IMAGE:4");
}

TEST_F(CheckedTransportTest, KeysAreChangedWithoutAStop) {
  EnvelopeKey next{.name = "plant"};
  next.secret.fill(0x11);
  EnvelopeSeal changed{next, 8};
  EXPECT_EQ(heard("LIFT_SIGNED", sealed(changed, "LIFT_IMAGE", 1)), "");
  write_key('1');
  now += 1s;
  EXPECT_EQ(heard("LIFT_SIGNED", sealed(changed, "LIFT_IMAGE", 2)), "LIFT_IMAGE:2");
  EXPECT_EQ(heard("LIFT_SIGNED", sealed(daemon, "LIFT_IMAGE", 3)), "") << "the key from before";
}

}  // namespace
}  // namespace takt
