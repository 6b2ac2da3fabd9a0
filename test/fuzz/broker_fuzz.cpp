#include <array>
#include <cstddef>
#include <cstdint>
#include <netinet/in.h>
#include <string>
#include <sys/socket.h>
#include <vector>

#include "master/lcm/tcpq/tcpq_broker.hpp"
#include "master/lcm/tcpq/tcpq_parser.hpp"
#include "master/linux/file_descriptor.hpp"
#include "test/fuzz/input.hpp"

namespace {

using takt::fuzz::demand;
using takt::fuzz::Input;

takt::TcpqBroker& broker() {
  static const auto listening = [] {
    auto made = takt::TcpqBroker::listen(0).value();
    made->subscribe("OWN.*");
    return made;
  }();
  return *listening;
}

void serve() {
  broker().serve([](std::string_view channel, std::span<const std::byte>) {
    demand(channel.starts_with("OWN"));
  });
}

/// A connection that is closed by a reset, so that thousands of them leave no socket in TIME_WAIT.
class Client {
 public:
  Client() : socket_{::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)} {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(broker().port());
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const linger reset{.l_onoff = 1, .l_linger = 0};
    ::setsockopt(socket_.get(), SOL_SOCKET, SO_LINGER, &reset, sizeof reset);
    demand(::connect(socket_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) ==
           0);
  }
  void send(std::span<const std::byte> bytes) const {
    static_cast<void>(
        ::send(socket_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT));
  }
  void read() const {
    std::array<std::byte, 4096> some;
    static_cast<void>(::recv(socket_.get(), some.data(), some.size(), MSG_DONTWAIT));
  }
  void end() const { ::shutdown(socket_.get(), SHUT_WR); }

 private:
  takt::FileDescriptor socket_;
};

void send_message(const Client& client, Input& input) {
  std::vector<std::byte> bytes;
  const auto type = static_cast<takt::tcpq::Type>(1 + input.byte() % 3);
  const std::string channel{input.text(input.byte())};
  const auto data = std::as_bytes(input.bytes(input.byte()));
  takt::tcpq::append(bytes, {.type = type, .channel = channel, .data = data});
  client.send(bytes);
}

void act(const Client& client, std::uint8_t what, Input& input) {
  switch (what % 8) {
    case 0:
    case 1:
      return client.send(std::as_bytes(input.bytes(input.byte())));
    case 2: {
      std::vector<std::byte> opening;
      takt::tcpq::append_opening(opening, takt::tcpq::magic_client);
      return client.send(opening);
    }
    case 3:
    case 4:
      return send_message(client, input);
    case 5:
      return client.read();
    case 6:
      return client.end();
    default:
      broker().publish(std::string{input.text(input.byte() % 16)},
                       std::as_bytes(input.bytes(input.byte())));
  }
}

}  // namespace

/// Sends any bytes over several connections to the broker of tcpq://. At the end, nobody is
/// connected.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Input input{data, size};
  {
    const std::vector<Client> clients(1 + input.byte() % 4);
    for (int acts = 0; acts < 200 && !input.empty(); ++acts) {
      const std::uint8_t what = input.byte();
      act(clients[what / 8 % clients.size()], what, input);
      if (what >= 128) serve();
    }
    serve();
  }
  for (int rounds = 0; broker().clients() != 0; ++rounds) {
    demand(rounds < 100'000);
    serve();
  }
  return 0;
}
