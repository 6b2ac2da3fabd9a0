#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "master/gateway/bridge.hpp"
#include "master/lcm/messages.hpp"
#include "test/fuzz/input.hpp"
#include "test/fuzz/virtual_master.hpp"

namespace {

using takt::Bytes;
using takt::fuzz::demand;
using takt::fuzz::Input;

constexpr std::int64_t session = 7;

/// Delivers the messages that the test has put into it, and discards what is published.
class Inbox final : public takt::Transport {
 public:
  bool publish(const std::string& channel, Bytes) override {
    demand(!channel.empty());
    return true;
  }
  void subscribe(const std::string&) override {}
  void serve(const takt::MessageHandler& handler) override {
    for (; !waiting_.empty(); waiting_.pop_front()) {
      handler(waiting_.front().first, waiting_.front().second);
    }
  }
  void watch(std::vector<pollfd>&) const override {}
  bool good() const override { return true; }
  std::string url() const override { return "memq://"; }

  void put(const std::string& channel, Bytes data) {
    waiting_.emplace_back(channel, std::vector<std::byte>{data.begin(), data.end()});
  }

 private:
  std::deque<std::pair<std::string, std::vector<std::byte>>> waiting_;
};

template <class T>
void fill_numbers(std::vector<T>& numbers, std::size_t count, unsigned width, Input& input) {
  for (std::size_t i = 0; i < count; ++i) {
    numbers.push_back(static_cast<T>(input.number(width)));
  }
}

std::string word(Input& input) { return std::string{input.text(input.byte() % 32)}; }

/// The gateway of a booted master, and a sender whose messages come from the input.
class Gateway {
 public:
  Gateway() : bridge_{master_.master, lcm_, clocks_, options(), [](const takt::Notice&) {}} {}

  void act(Input& input) {
    switch (const std::uint8_t what = input.byte(); what % 8) {
      case 0:
        return send_raw(input);
      case 1:
        return send(bridge_.channels().command, command(input), input);
      case 2:
        return send(bridge_.channels().motion_command, motion(input), input);
      case 3:
        return send(bridge_.channels().request, request(input), input);
      case 4:
        return send(bridge_.channels().transfer, transfer(input), input);
      case 5:
        return send_typed(input);
      default:
        for (int i = what / 8; i >= 0; --i) cycle();
    }
  }
  void cycle() {
    master_.master.cycle();
    bridge_.serve();
  }

 private:
  static takt::BridgeOptions options() {
    takt::BridgeOptions options;
    options.session = session;
    options.motions = true;
    return options;
  }
  /// Returns the newest cycle, one near it, or any number.
  std::int64_t cycle_number(Input& input) const {
    const auto newest = static_cast<std::int64_t>(bridge_.status().bus.cycle);
    const std::uint8_t how = input.byte();
    if (how == 255) return static_cast<std::int64_t>(input.number(8));
    return newest + how % 16 - 12;
  }
  takt::command_t command(Input& input) const {
    takt::command_t message{};
    message.schema = takt::message_schema;
    message.session = session;
    const std::uint8_t who = input.byte();
    message.instance = who % 4;
    message.release = who >= 0xC0;
    message.sender = word(input);
    message.cycle = cycle_number(input);
    message.time_to_live = static_cast<std::int32_t>(input.number(input.byte() % 5));
    const std::size_t count = input.byte() % 16;
    fill_numbers(message.signals, count, 1, input);
    fill_numbers(message.values, count, 1 + input.byte() % 8, input);
    message.num_values = static_cast<std::int32_t>(count);
    return message;
  }
  /// Returns any number for a position or a limit, often one that a real command would have.
  static double number(Input& input) {
    constexpr std::array usual{0.0, 0.5, -1.0, 2.0, 20.0, 400.0};
    const std::uint8_t which = input.byte();
    return which < 0xE0 ? usual[which % usual.size()] : std::bit_cast<double>(input.number(8));
  }
  takt::motion_command_t motion(Input& input) const {
    constexpr std::array kinds{"move", "jog", "stop", "alive"};
    constexpr std::array nodes{"shoulder", "elbow", "io"};
    takt::motion_command_t message{};
    message.schema = takt::message_schema;
    message.session = session;
    message.instance = input.byte() % 4;
    message.sender = word(input);
    message.cycle = cycle_number(input);
    message.id = input.byte();
    const std::uint8_t kind = input.byte();
    message.kind = kind < 0xF0 ? kinds[kind % kinds.size()] : word(input);
    message.timeout_ms = static_cast<std::int32_t>(input.number(input.byte() % 5));
    for (int i = input.byte() % 4; i > 0; --i) {
      takt::motion_goal_t goal{};
      goal.node = nodes[input.byte() % nodes.size()];
      goal.axis = static_cast<std::int8_t>(input.byte() % 3);
      goal.position = number(input);
      goal.velocity = number(input);
      goal.max_velocity = number(input);
      goal.max_acceleration = number(input);
      goal.max_jerk = number(input);
      goal.max_following_error = number(input);
      message.goals.push_back(goal);
    }
    message.num_goals = static_cast<std::int32_t>(message.goals.size());
    return message;
  }
  static takt::request_t request(Input& input) {
    constexpr std::array services{"sdo_upload", "sdo_download", "nmt",
                                  "pdo_poll",   "lss",          "emcy_history",
                                  "record",     "pdo_exchange", "device_file"};
    takt::request_t message{};
    begin(message, input);
    const std::uint8_t service = input.byte();
    message.service = service < services.size() ? services[service] : word(input);
    message.nmt_command = static_cast<std::int16_t>(input.byte());
    message.timeout_ms = static_cast<std::int32_t>(input.number(2));
    end(message, input);
    return message;
  }
  static takt::transfer_t transfer(Input& input) {
    constexpr std::array actions{"download", "upload", "data", "more", "status", "abort", "end"};
    takt::transfer_t message{};
    begin(message, input);
    const std::uint8_t action = input.byte();
    message.action = action < actions.size() ? actions[action] : word(input);
    message.total = static_cast<std::int64_t>(input.number(input.byte() % 9));
    message.offset = static_cast<std::int64_t>(input.number(input.byte() % 9));
    end(message, input);
    return message;
  }
  template <class Message>
  static void begin(Message& message, Input& input) {
    message.schema = takt::message_schema;
    message.sender = word(input);
    message.id = input.byte() % 4;
    constexpr std::array<std::int16_t, 4> nodes{1, 2, 10, 0};
    const std::uint8_t node = input.byte();
    message.node_id = node < nodes.size() ? nodes[node] : static_cast<std::int16_t>(node);
    message.index = static_cast<std::int32_t>(input.number(2));
    message.sub = static_cast<std::int16_t>(input.byte());
  }
  template <class Message>
  static void end(Message& message, Input& input) {
    for (const std::uint8_t byte : input.bytes(input.byte())) message.data.push_back(byte);
    message.size = static_cast<std::int32_t>(message.data.size());
  }
  /// Sends the encoded message: as it is, with one byte changed, or cut.
  template <class Message>
  void send(const std::string& channel, const Message& message, Input& input) {
    std::vector<std::byte> buffer;
    const Bytes encoded = takt::encode(message, buffer);
    std::vector<std::byte> bytes{encoded.begin(), encoded.end()};
    const std::uint8_t how = input.byte();
    if (how >= 0xF0) bytes[input.number(2) % bytes.size()] = std::byte{input.byte()};
    if (how >= 0xF8) bytes.resize(input.number(2) % (bytes.size() + 1));
    lcm_.put(channel, bytes);
  }
  void send_raw(Input& input) {
    const auto heard = bridge_.channels().heard();
    const std::string& channel = heard[input.byte() % heard.size()];
    lcm_.put(channel, std::as_bytes(input.bytes(input.byte())));
  }
  /// Sends any bytes as the set-points of one node.
  void send_typed(Input& input) {
    static const auto heard = takt::TypedChannels::heard(takt::fuzz::demo_network().plan);
    const std::string& channel = heard[input.byte() % heard.size()];
    lcm_.put(channel, std::as_bytes(input.bytes(input.byte())));
  }

  takt::fuzz::VirtualMaster master_;
  takt::fuzz::VirtualClocks clocks_{master_};
  Inbox lcm_;
  takt::Bridge bridge_;
};

}  // namespace

/// Sends any messages to the gateway of a whole master, on the channels that the daemon receives.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Input input{data, size};
  const auto gateway = std::make_unique<Gateway>();
  gateway->cycle();
  for (int acts = 0; acts < 100 && !input.empty(); ++acts) gateway->act(input);
  for (int i = 0; i < 20; ++i) gateway->cycle();
  return 0;
}
