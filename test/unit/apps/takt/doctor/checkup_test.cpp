#include "apps/takt/doctor/checkup.hpp"

#include <cstdlib>
#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

#include "test/support/folder.hpp"

namespace takt::doctor {
namespace {

namespace fs = std::filesystem;

/// A root folder with the kernel files that a test writes.
class Root : public test::Folder {
 public:
  void write(const fs::path& file, const std::string& text) const {
    Folder::write(file, text + '\n');
  }
};

const Remark* about(const std::vector<Remark>& remarks, const std::string& subject) {
  for (const Remark& remark : remarks) {
    if (remark.subject == subject) return &remark;
  }
  return nullptr;
}

CanLink healthy() {
  return {.name = "can0",
          .kind = "can",
          .is_can = true,
          .up = true,
          .tx_queue_length = 256,
          .bitrate = 500'000,
          .restart_ms = 100,
          .state = CanState::error_active};
}

TEST(Doctor, CallsAFitInterfaceGood) {
  const auto remarks = judge_link(healthy(), {});
  ASSERT_EQ(remarks.size(), 1U);
  EXPECT_EQ(remarks[0].verdict, Verdict::good);
  EXPECT_EQ(remarks[0].text, "up, 500 kbit/s, sends up to 256 frames at once, error-active");
  EXPECT_TRUE(remarks[0].command.empty());
}

TEST(Doctor, GivesTheCommandThatBringsAnInterfaceUp) {
  CanLink link = healthy();
  link.up = false;
  link.bitrate = 0;

  const auto remarks = judge_link(link, 250'000);

  ASSERT_EQ(remarks.size(), 1U);
  EXPECT_EQ(remarks[0].verdict, Verdict::bad);
  EXPECT_EQ(remarks[0].command, "ip link set can0 up type can bitrate 250000 restart-ms 100");
  EXPECT_EQ(judge_link(link, {})[0].command,
            "ip link set can0 up type can bitrate 1000000 restart-ms 100");
  link.kind = "vcan";
  EXPECT_EQ(judge_link(link, {})[0].command, "ip link set can0 up");
}

TEST(Doctor, ReportsEachFaultOfAnInterfaceWithItsCommand) {
  CanLink link = healthy();
  link.tx_queue_length = 10;
  link.restart_ms = 0;
  link.state = CanState::error_passive;

  const auto remarks = judge_link(link, 1'000'000);

  ASSERT_EQ(remarks.size(), 4U);
  EXPECT_EQ(remarks[0].command,
            "ip link set can0 down && ip link set can0 up type can bitrate 1000000");
  EXPECT_EQ(remarks[1].command, "ip link set can0 txqueuelen 128");
  EXPECT_EQ(remarks[2].command,
            "ip link set can0 down && ip link set can0 up type can restart-ms 100");
  EXPECT_NE(remarks[3].text.find("error-passive"), std::string::npos);
  EXPECT_TRUE(remarks[3].command.empty());
  for (const Remark& remark : remarks) EXPECT_EQ(remark.verdict, Verdict::bad);
}

TEST(Doctor, TakesNoEthernetForABus) {
  CanLink link = healthy();
  link.name = "eth0";
  link.is_can = false;
  EXPECT_EQ(judge_link(link, {})[0].verdict, Verdict::bad);
}

TEST(Doctor, SaysHowToMakeAVirtualInterfaceThatIsMissing) {
  const auto remarks = check_interface("vcan77", {});
  ASSERT_EQ(remarks.size(), 1U);
  EXPECT_EQ(remarks[0].verdict, Verdict::bad);
  EXPECT_EQ(remarks[0].command, "ip link add dev vcan77 type vcan && ip link set vcan77 up");
}

TEST(Doctor, KnowsARealtimeKernelASlowClockAndAThriftyGovernor) {
  const Root good;
  good.write("sys/kernel/realtime", "1");
  good.write("sys/devices/system/clocksource/clocksource0/current_clocksource", "tsc");
  good.write("sys/devices/system/cpu/cpu0/cpufreq/scaling_governor", "performance");
  for (const Remark& remark : check_machine(good.path())) {
    EXPECT_EQ(remark.verdict, Verdict::good) << remark.text;
  }
  const Root bad;
  bad.write("sys/devices/system/clocksource/clocksource0/current_clocksource", "hpet");
  bad.write("sys/devices/system/cpu/cpu0/cpufreq/scaling_governor", "powersave");

  const auto remarks = check_machine(bad.path());

  EXPECT_EQ(about(remarks, "clock")->verdict, Verdict::hint);
  EXPECT_EQ(about(remarks, "CPU frequency")->verdict, Verdict::hint);
  EXPECT_EQ(about(remarks, "CPU frequency")->command, "cpupower frequency-set -g performance");
}

TEST(Doctor, ReportsWhatRealTimeWasRefused) {
  RtReport report;
  report.priority = 80;
  report.memory_locked = true;
  EXPECT_EQ(judge_realtime(report)[0].verdict, Verdict::good);
  report.missing = {"SCHED_FIFO 80: Operation not permitted (RLIMIT_RTPRIO is 0 ...)"};

  const auto remarks = judge_realtime(report);

  ASSERT_EQ(remarks.size(), 1U);
  EXPECT_EQ(remarks[0].verdict, Verdict::bad);
  EXPECT_EQ(remarks[0].text, report.missing[0]);
}

TEST(Doctor, JudgesSocketBuffersOnlyWhereLcmNeedsThem) {
  const Root root;
  root.write("proc/sys/net/core/rmem_max", "212992");

  const auto multicast = check_lcm("udpm://239.255.76.67:7667?ttl=0", root.path());
  const auto tcp = check_lcm("tcpq://127.0.0.1:7700", root.path());

  ASSERT_NE(about(multicast, "socket buffers"), nullptr);
  EXPECT_EQ(about(multicast, "socket buffers")->verdict, Verdict::hint);
  EXPECT_EQ(about(multicast, "socket buffers")->command, "sysctl -w net.core.rmem_max=2097152");
  ASSERT_EQ(tcp.size(), 1U);
  EXPECT_EQ(tcp[0].verdict, Verdict::good);
  EXPECT_EQ(check_lcm("nonsense", root.path())[0].verdict, Verdict::bad);
}

}  // namespace
}  // namespace takt::doctor
