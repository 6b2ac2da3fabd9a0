#include "master/gateway/ascii/ascii_gateway.hpp"

#include <deque>
#include <fstream>
#include <gtest/gtest.h>
#include <random>
#include <sstream>

#include "master/sim/device/device.hpp"
#include "test/virtual/rig.hpp"

namespace takt::test {
namespace {

using namespace std::chrono_literals;

/// A complete master with devices in virtual time behind a gateway with one client.
class GatewayRig {
 public:
  explicit GatewayRig(BusPlan plan, RigOptions options = {})
      : rig{std::move(plan), std::move(options)},
        gateway{rig.master->plan(),
                {.submit = [this](const Request& request) { return rig.master->submit(request); },
                 .write =
                     [this](const auto& signals, const auto& values) {
                       for (std::size_t i = 0; i < signals.size(); ++i) {
                         rig.master->set(signals[i], values[i]);
                       }
                       rig.master->publish_outputs(rig.world->now());
                       return true;
                     },
                 .send = [this](int, const std::string& line) { declared.push_back(line); }}} {
    rig.on_image = [this](const ImageView& image) { gateway.see(image); };
  }
  void connect() { gateway.connect(1); }
  void cycle() {
    const std::size_t before = rig.events.size();
    rig.cycle();
    for (Reply reply; rig.master->take(reply);) gateway.take(reply);
    for (std::size_t i = before; i < rig.events.size(); ++i) gateway.hear(rig.events[i]);
  }
  /// Returns the next line, or a text that tells what came instead.
  std::string next_line() {
    for (int i = 0; i < 20'000 && declared.empty(); ++i) cycle();
    if (declared.empty()) return "(nothing)";
    std::string line = declared.front();
    declared.pop_front();
    return line;
  }

  Rig rig;
  AsciiGateway gateway;
  std::deque<std::string> declared;
};

void harm(GatewayRig& rig, const std::string& words) {
  std::istringstream in{words};
  std::string what;
  unsigned node = 0;
  in >> what >> node;
  sim::Device& device = *rig.rig.world->device(*NodeId::from(node));
  if (what == "mute") device.faults().mute_sdo = true;
  if (what != "fail") return;
  std::string code;
  in >> code;
  rig.rig.world->add({.kind = sim::FaultKind::device_error,
                      .node = NodeId::from(node),
                      .at = rig.rig.world->now() + 1ms,
                      .emcy_code = static_cast<std::uint16_t>(std::stoul(code, nullptr, 16))});
}

/// Plays a hand-written dialogue.
void play(const std::string& name, GatewayRig& rig) {
  std::ifstream file{TAKT_SOURCE_DIR "/test/unit/master/gateway/ascii/dialogues/" + name};
  ASSERT_TRUE(file) << name;
  int number = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    if (line.size() < 2) continue;
    const std::string rest = line.substr(2);
    if (line[0] == '>') rig.gateway.command(1, rest);
    if (line[0] == '<') {
      EXPECT_EQ(rig.next_line(), rest) << name << ":" << number;
    }
    if (line[0] == '!') harm(rig, rest);
    for (int i = line[0] == '.' ? std::stoi(rest) : 0; i > 0; --i) rig.cycle();
  }
  EXPECT_TRUE(rig.declared.empty()) << rig.declared.front();
}

DeviceTable lss_device(const BusPlan& plan, std::size_t row, std::uint32_t serial) {
  DeviceTable table =
      loopback_device(plan.nodes[row].id, plan.pdos.tpdos[row], plan.pdos.rpdos[row]);
  for (std::uint8_t sub = 2; sub <= 4; ++sub) {
    table.objects.push_back({.key = {0x1018, sub},
                             .type = DataType::unsigned32,
                             .access = Access::ro,
                             .value = sim::little_endian(sub == 4 ? serial : sub, 4),
                             .low_limit = {},
                             .high_limit = {}});
  }
  std::ranges::sort(table.objects, {}, &DeviceObject::key);
  table.quirks.push_back("no_node_id");
  return table;
}

TEST(AsciiDialogue, Sdo) {
  GatewayRig rig{axes({.nodes = 2})};
  ASSERT_TRUE(rig.rig.boot());
  rig.connect();
  play("sdo.txt", rig);
}

TEST(AsciiDialogue, Mistakes) {
  GatewayRig rig{axes({.nodes = 2})};
  ASSERT_TRUE(rig.rig.boot());
  rig.connect();
  play("mistakes.txt", rig);
}

TEST(AsciiDialogue, NmtAndPdo) {
  BusPlan plan = axes({.nodes = 2, .fallback_cycles = 0});
  for (NodePlan& node : plan.nodes) node.cia402 = false;
  GatewayRig rig{std::move(plan)};
  ASSERT_TRUE(rig.rig.boot());
  rig.connect();
  for (int i = 0; i < 10; ++i) rig.cycle();
  play("nmt_and_pdo.txt", rig);
}

TEST(AsciiDialogue, Lss) {
  BusPlan plan = axes({.nodes = 2});
  for (NodePlan& node : plan.nodes) node.boot = false;
  RigOptions options;
  options.devices.push_back(lss_device(plan, 0, 17));
  options.devices.push_back(lss_device(plan, 1, 18));
  GatewayRig rig{std::move(plan), std::move(options)};
  rig.rig.run(200);
  rig.connect();
  play("lss.txt", rig);
}

TEST(AsciiGateway, ReportsBootUpsUnlessAClientDoesNotWantThem) {
  GatewayRig rig{axes({.nodes = 1})};
  ASSERT_TRUE(rig.rig.boot());
  rig.connect();
  const Event event{.kind = EventKind::bootup_again, .node = 1};
  rig.gateway.hear(event);
  EXPECT_EQ(rig.next_line(), "1 1 BOOT_UP");
  rig.gateway.command(1, "[1] boot_up_indication Disable");
  rig.gateway.hear(event);
  EXPECT_EQ(rig.declared, (std::deque<std::string>{"[1] OK"}));
}

TEST(AsciiGateway, ReportsTheBootUpOfANodeThatItResets) {
  GatewayRig rig{axes({.nodes = 2})};
  ASSERT_TRUE(rig.rig.boot());
  rig.connect();
  rig.gateway.command(1, "[1] 1 reset node");
  for (int i = 0; i < 500; ++i) rig.cycle();
  EXPECT_TRUE(rig.rig.all_ready());
  const auto at = [&](const char* line) { return std::ranges::find(rig.declared, line); };
  EXPECT_EQ(std::ranges::count(rig.declared, "1 1 BOOT_UP"), 1);
  EXPECT_LT(at("[1] OK"), at("1 1 BOOT_UP"));
  EXPECT_LT(at("1 1 BOOT_UP"), at("1 1 USER BOOT OK"));
  EXPECT_NE(at("1 1 USER BOOT OK"), rig.declared.end());
}

TEST(AsciiGateway, HelpsInLines) {
  GatewayRig rig{axes({.nodes = 1})};
  rig.connect();
  rig.gateway.command(1, "[3] help");
  ASSERT_GT(rig.declared.size(), 10U);
  EXPECT_EQ(rig.declared.back(), "[3] OK");
  rig.declared.pop_back();
  for (const std::string& line : rig.declared) {
    EXPECT_TRUE(line.starts_with("# ")) << line;
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
  }
}

TEST(AsciiGateway, ReportsErrorControlAndBusErrors) {
  GatewayRig rig{axes({.nodes = 1})};
  rig.connect();
  Event failed{.kind = EventKind::boot_failed, .node = 1};
  failed.failure.letter = 'D';
  rig.gateway.hear(failed);
  rig.gateway.hear({.kind = EventKind::heartbeat_lost, .node = 1});
  rig.gateway.hear({.kind = EventKind::guarding_lost, .node = 1});
  rig.gateway.hear({.kind = EventKind::boot_done, .node = 1});
  rig.gateway.hear({.kind = EventKind::bus_off});
  rig.gateway.hear({.kind = EventKind::cycles_missed});
  EXPECT_EQ(rig.declared,
            (std::deque<std::string>{"1 1 USER BOOT D", "1 1 ERROR 203 (heartbeat lost)",
                                     "1 1 ERROR 200 (lost guarding message)", "1 1 USER BOOT OK",
                                     "1 ERROR 301 (bus off)"}));
}

TEST(AsciiGateway, RefusesMoreThanSixteenCommandsAtOnce) {
  GatewayRig rig{axes({.nodes = 1})};
  ASSERT_TRUE(rig.rig.boot());
  rig.connect();
  for (int i = 1; i <= 17; ++i) {
    rig.gateway.command(1, "[" + std::to_string(i) + "] 1 r 0x1000 0 u32");
  }
  EXPECT_EQ(
      rig.declared,
      (std::deque<std::string>{"[17] ERROR: 102 (request not processed due to internal state)"}));
}

TEST(AsciiGateway, DoesNothingOfALineThatWaitedAndSaysSo) {
  GatewayRig rig{test::axes({.nodes = 1})};
  rig.connect();
  rig.gateway.refuse_waited(1, "[7] 1 stop", 2500ms);
  rig.gateway.refuse_waited(1, "", 2500ms);
  rig.gateway.refuse_waited(1, "[8] 1 nonsense", 2500ms);

  ASSERT_EQ(rig.declared.size(), 2U);
  EXPECT_EQ(rig.declared[0].find("[7] ERROR: 102 ("), 0U) << rig.declared[0];
  EXPECT_NE(rig.declared[0].find("taktd did not run for 2500 ms"), std::string::npos)
      << rig.declared[0];
  EXPECT_EQ(rig.declared[1].find("[8] ERROR: 101 ("), 0U) << rig.declared[1];
  EXPECT_FALSE(rig.gateway.awaits_reply(1));
}

TEST(AsciiGateway, AfterAShortGapRefusesSetPointsThatWaitedAndTakesRequests) {
  GatewayRig rig{test::axes({.nodes = 1})};
  ASSERT_TRUE(rig.rig.boot());
  rig.connect();
  rig.gateway.refuse_waited_outputs(1, "[7] 1 w p 1 1 15", 950ms);
  rig.gateway.refuse_waited_outputs(1, "[8] set node 1", 950ms);
  rig.gateway.refuse_waited_outputs(1, "[9] 1 r 0x1000 0 u32", 950ms);

  EXPECT_EQ(
      rig.declared,
      (std::deque<std::string>{
          "[7] ERROR: 102 (request not processed due to internal state: taktd did not run for 950 "
          "ms, and this line may have waited as long: send it again)",
          "[8] OK"}));
  EXPECT_TRUE(rig.gateway.awaits_reply(1)) << "the SDO upload is on its way";
}

TEST(AsciiGateway, ForgetsAClientThatHasLeft) {
  GatewayRig rig{axes({.nodes = 1})};
  ASSERT_TRUE(rig.rig.boot());
  rig.connect();
  rig.gateway.command(1, "[1] 1 r 0x1000 0 u32");
  rig.gateway.disconnect(1);
  for (int i = 0; i < 100; ++i) rig.cycle();
  rig.gateway.command(1, "[2] 1 r 0x1000 0 u32");
  EXPECT_TRUE(rig.declared.empty());
}

TEST(AsciiGateway, AnswersAnyGarbageWithOneLineOrNone) {
  GatewayRig rig{axes({.nodes = 1})};
  ASSERT_TRUE(rig.rig.boot());
  rig.connect();
  std::mt19937 random{7};
  const std::string letters = "[]0123456789 \"#xXrwpdo-us\\\t\r\x01\x7F\xFF,.lss_set";
  for (int i = 0; i < 20'000; ++i) {
    std::string line{i % 3 == 0 ? "[5] " : ""};
    for (auto left = random() % 60; left != 0; --left) line += letters[random() % letters.size()];
    rig.gateway.command(1, line);
    ASSERT_LE(rig.declared.size(), 1U) << line;
    for (const std::string& answer : rig.declared) {
      EXPECT_EQ(answer.find_first_of("\r\n\x01"), std::string::npos) << line;
    }
    rig.declared.clear();
    if (i % 10 == 0) rig.cycle();
    rig.declared.clear();
  }
}

}  // namespace
}  // namespace takt::test
