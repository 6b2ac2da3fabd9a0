// Any program on LCM can pretend to be a daemon. The tools must survive whatever it sends.
#include <chrono>
#include <gtest/gtest.h>
#include <memory>
#include <string>
#include <vector>

#include "master/lcm/messages.hpp"
#include "master/lcm/tcpq/tcpq_broker.hpp"
#include "test/e2e/process.hpp"
#include "test/support/folder.hpp"

namespace takt::test {
namespace {

/// Pretends to be the daemon of bus 'evil'. It serves an LCM hub, sends a status all the time, and
/// answers every request with the same bytes.
class ForgedDaemon {
 public:
  ForgedDaemon() { hub_->subscribe("EVIL_REQUEST"); }

  std::string url() const { return hub_->url(); }
  void answer_with(std::vector<std::uint8_t> data) { data_ = std::move(data); }
  /// Does one round of its work without waiting.
  void serve() {
    hub_->serve([this](std::string_view channel, Bytes data) {
      const auto request = decode<request_t>(data);
      if (channel == "EVIL_REQUEST" && request) answer(*request);
    });
    status_t status{};
    status.schema = message_schema;
    status.parts = 1;
    status.session = 4711;
    status.bus = "evil";
    status.interface = "can0\x1B[5m\x7F\xC2\x9B";
    status.utime = now_us();
    std::vector<std::byte> buffer;
    hub_->publish("EVIL_STATUS", encode(status, buffer));
  }

 private:
  static std::int64_t now_us() {
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    return std::chrono::duration_cast<std::chrono::microseconds>(now).count();
  }
  void answer(const request_t& request) {
    reply_t reply{};
    reply.schema = message_schema;
    reply.session = 4711;
    reply.id = request.id;
    reply.sender = request.sender;
    reply.good = 1;
    reply.data = data_;
    reply.size = static_cast<std::int32_t>(data_.size());
    std::vector<std::byte> buffer;
    hub_->publish("EVIL_REPLY", encode(reply, buffer));
  }

  std::unique_ptr<TcpqBroker> hub_ = TcpqBroker::listen(0).value();
  std::vector<std::uint8_t> data_;
};

class ForgedMessages : public testing::Test {
 protected:
  Ended takt(std::vector<std::string> words) {
    words.insert(words.begin(), TAKT);
    words.insert(words.end(), {"--lcm-url", daemon_.url(), "--bus-name", "evil"});
    Process process{words, folder_ / "output"};
    const auto code = process.wait([this] { daemon_.serve(); });
    return {code, process.output()};
  }

  const Folder folder_;
  ForgedDaemon daemon_;
};

TEST_F(ForgedMessages, AnLssReplyWithoutResultsIsRefused) {
  for (const std::size_t size : {0U, 23U, 24U}) {
    daemon_.answer_with(std::vector<std::uint8_t>(size, 0));
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"lss", "find"}, {"lss", "inquire", "--alone"}}) {
      const Ended refused = takt(words);

      EXPECT_EQ(refused.exit_code, 3) << words[1];
      EXPECT_NE(refused.output.find("the daemon of bus 'evil' sent a reply of"), std::string::npos)
          << refused.output;
    }
  }
}

TEST_F(ForgedMessages, ControlCharactersOfAStatusAreEscapedInJson) {
  const Ended shown = takt({"status", "--json"});

  EXPECT_EQ(shown.exit_code, 0) << shown.output;
  EXPECT_NE(shown.output.find(R"("can0\u001b[5m\u007f\u009b")"), std::string::npos) << shown.output;
}

}  // namespace
}  // namespace takt::test
