#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "master/gateway/ascii/ascii_gateway.hpp"
#include "test/fuzz/input.hpp"
#include "test/fuzz/virtual_master.hpp"

namespace {

using takt::fuzz::demand;
using takt::fuzz::Input;

/// The text gateway of a booted master, with two clients.
class Gateway {
 public:
  Gateway() {
    gateway_.connect(1);
    gateway_.connect(2);
  }
  void command(int client, std::string_view line) { gateway_.command(client, line); }
  void leave(int client) {
    gateway_.disconnect(client);
    gateway_.connect(client);
  }
  void run(int cycles) {
    for (int i = 0; i < cycles; ++i) cycle();
  }

 private:
  void cycle() {
    takt::MasterRun& master = master_.master;
    master.cycle();
    for (takt::ImageView image; master.take(image);) gateway_.see(image);
    for (takt::Event event; master.take(event);) gateway_.hear(event);
    for (takt::Reply reply; master.take(reply);) gateway_.take(reply);
  }
  bool write(const std::vector<takt::SignalIndex>& signals,
             const std::vector<std::int64_t>& values) {
    demand(signals.size() == values.size());
    for (std::size_t i = 0; i < signals.size(); ++i) {
      demand(signals[i] < master_.master.plan().layout.signals.size());
      if (!master_.master.set(signals[i], values[i])) return false;
    }
    master_.master.publish_outputs(master_.now());
    return true;
  }

  takt::fuzz::VirtualMaster master_;
  takt::AsciiGateway gateway_{
      master_.master.plan(),
      {.submit = [this](const takt::Request& request) { return master_.master.submit(request); },
       .write = [this](const auto& signals, const auto& values) { return write(signals, values); },
       .send = [](int, const std::string& line) { demand(line.find('\n') == std::string::npos); }}};
};

}  // namespace

/// Sends any lines of two clients to the text gateway (CiA 309-3). A line that begins with 0x01
/// comes from the second client. 0x02 lets time pass. With 0x03, the first client disconnects and
/// connects again.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string_view text{reinterpret_cast<const char*>(data), size};
  const auto gateway = std::make_unique<Gateway>();
  for (int lines = 0; lines < 60 && !text.empty(); ++lines) {
    const std::size_t end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (line.starts_with('\1')) {
      gateway->command(2, line.substr(1));
    } else if (line.starts_with('\2')) {
      gateway->run(20);
    } else if (line.starts_with('\3')) {
      gateway->leave(1);
    } else {
      gateway->command(1, line);
    }
    gateway->run(1);
  }
  gateway->run(40);
  return 0;
}
