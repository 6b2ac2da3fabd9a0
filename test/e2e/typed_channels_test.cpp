#include <bit>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>

#include "eds_parser/lcm/typed_message.hpp"
#include "eds_parser/network_file/load_network.hpp"
#include "master/linux/clock.hpp"
#include "test/e2e/daemon_process.hpp"
#include "test/support/folder.hpp"

namespace takt::test {
namespace {

constexpr double unchanged = std::numeric_limits<double>::quiet_NaN();

template <class T>
void put(std::vector<std::byte>& out, T value) {
  for (std::size_t i = sizeof value; i-- > 0;) {
    out.push_back(static_cast<std::byte>(static_cast<std::uint64_t>(value) >> (8 * i)));
  }
}

/// An application that knows only the types that `takt export lcm` writes for the shoulder of the
/// demo.
class TypedApplication {
 public:
  TypedApplication(const std::filesystem::path& network, const std::string& url)
      : types_{typed_messages(load_network(network).plan)},
        lcm_{LcmClient::open(url, {"DEMO_SHOULDER_STATE"}).value()} {}

  void listen() {
    const auto take = [&](std::string_view, Bytes data) {
      state_.assign(data.begin(), data.end());
    };
    lcm_.serve(take, monotonic_now() + std::chrono::milliseconds{1});
  }
  bool heard() const { return state_.size() == 70 && number(0, 8) == types_.at(0).fingerprint(); }
  std::uint64_t session() const { return number(24, 8); }
  std::uint64_t statusword() const { return number(41, 4); }
  double position() const { return std::bit_cast<double>(number(46, 8)); }

  void command(int controlword, double target, std::int64_t session_offset = 0) {
    std::vector<std::byte> bytes;
    put(bytes, types_.at(1).fingerprint());
    put(bytes, std::int64_t{0});
    put(bytes, static_cast<std::int64_t>(session()) + session_offset);
    put(bytes, std::int64_t{77});  // instance
    put(bytes, std::int32_t{4});
    for (const char c : {'e', '2', 'e', '\0'}) bytes.push_back(static_cast<std::byte>(c));
    put(bytes, number(32, 8));  // cycle
    put(bytes, std::int32_t{0});
    put(bytes, std::int8_t{0});  // release
    put(bytes, std::int32_t{controlword});
    put(bytes, std::int8_t{8});  // cyclic synchronous position
    put(bytes, std::bit_cast<std::uint64_t>(target));
    lcm_.publish("DEMO_SHOULDER_COMMAND", bytes);
  }
  /// Commands the next controlword on the way to Operation enabled. CiA 402.
  void enable(double target) {
    const std::uint64_t state = statusword() & 0x6F;
    command(state == 0x21 ? 7 : state == 0x23 || state == 0x27 ? 15 : 6, target);
  }

 private:
  std::uint64_t number(std::size_t at, std::size_t size) const {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < size && at + i < state_.size(); ++i) {
      value = value << 8U | std::to_integer<unsigned>(state_[at + i]);
    }
    return value;
  }

  std::vector<TypedMessage> types_;
  LcmClient lcm_;
  std::vector<std::byte> state_;
};

TEST(TypedChannels, MoveAnAxisInSi) {
  const Folder folder;
  const auto network = slow_network(folder.path());
  DaemonProcess daemon{network};
  ASSERT_TRUE(daemon.hear([&] { return daemon.all_ready(); })) << daemon.log();
  TypedApplication application{network, daemon.lcm_url()};

  double target = 0;
  const bool moved = daemon.work(
      [&] {
        application.listen();
        if (!application.heard()) return;
        const bool enabled = (application.statusword() & 0x6F) == 0x27;
        if (enabled) target = std::min(target + 0.002, 0.1);
        application.enable(enabled ? target : unchanged);
      },
      [&] {  // 0.1 rad at 10,000 counts per turn; the typed message and the image come separately
        return std::abs(application.position() - 0.1) < 0.001 &&
               std::abs(daemon.value("shoulder", "position_actual_value") - 159) <= 2;
      });

  EXPECT_TRUE(moved) << application.position() << " rad, "
                     << daemon.value("shoulder", "position_actual_value") << '\n'
                     << daemon.log();
  EXPECT_EQ(daemon.events("bad_message"), 0U);
}

TEST(TypedChannels, ARecordedCommandOfAnotherSessionMovesNothing) {
  const Folder folder;
  const auto network = slow_network(folder.path());
  DaemonProcess daemon{network};
  ASSERT_TRUE(daemon.hear([&] { return daemon.all_ready(); })) << daemon.log();
  TypedApplication application{network, daemon.lcm_url()};

  EXPECT_TRUE(daemon.work(
      [&] {
        application.listen();
        if (application.heard()) application.command(6, unchanged, -1);
      },
      [&] { return daemon.events("command_refused", "another session") > 0; }))
      << daemon.log();
  EXPECT_EQ(application.statusword() & 0x6F, 0x40U) << "switch on disabled, as it came";
}

TEST(TypedChannels, ANumberThatTheDriveCannotHoldIsRefused) {
  const Folder folder;
  const auto network = slow_network(folder.path());
  DaemonProcess daemon{network};
  ASSERT_TRUE(daemon.hear([&] { return daemon.all_ready(); })) << daemon.log();
  TypedApplication application{network, daemon.lcm_url()};
  const auto refused = [&](double target, const char* kind, const char* why) {
    return daemon.work(
        [&] {
          application.listen();
          if (application.heard()) application.command(6, target);
        },
        [&] { return daemon.events(kind, why) > 0; });
  };

  EXPECT_TRUE(refused(1e9, "command_refused", "1591549430919, does not fit its 32 bits"))
      << daemon.log();
  EXPECT_TRUE(refused(1e300, "bad_message", "does not fit 64 bits")) << daemon.log();
  EXPECT_EQ(application.statusword() & 0x6F, 0x40U) << "the controlword beside it counts no more";
}

TEST(TypedChannels, AreAbsentWhereTheNetworkFileSaysSo) {
  const Folder folder;
  const auto network =
      slow_network(folder.path(), [](std::string& text) { text += "lcm: {typed: false}\n"; });
  DaemonProcess daemon{network};
  bool typed = false;
  auto listener = LcmClient::open(daemon.lcm_url(), {"DEMO_SHOULDER_STATE"}).value();
  ASSERT_TRUE(daemon.work(
      [&] {
        listener.serve([&](std::string_view, Bytes) { typed = true; },
                       monotonic_now() + std::chrono::milliseconds{1});
      },
      [&] { return daemon.all_ready(); }))
      << daemon.log();

  EXPECT_FALSE(typed);
}

}  // namespace
}  // namespace takt::test
