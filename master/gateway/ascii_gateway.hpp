#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"
#include "master/gateway/ascii_command.hpp"
#include "master/gateway/front_guest.hpp"

namespace takt {

/// What the gateway can do to the bus.
struct AsciiPorts {
  /// Hands a request to the bus thread; false: it has too many.
  std::function<bool(const Request&)> submit;
  /// Commands outputs; false: they are refused, and that was told as an event.
  std::function<bool(const std::vector<SignalIndex>&, const std::vector<std::int64_t>&)> write;
  /// A line (without its end) to one client.
  std::function<void(int client, const std::string& line)> send;
};

/// CiA 309-3: text commands of clients become requests, replies and events become lines. There is
/// one network, of number 1. Knows no sockets. Front thread.
class AsciiGateway final : public FrontGuest {
 public:
  static constexpr std::size_t most_pending = 16;  ///< commands of one client

  AsciiGateway(const BusPlan& plan, AsciiPorts ports);

  void connect(int client) { clients_[client] = {}; }
  void disconnect(int client);
  /// A command of this client is still to be answered.
  bool owes(int client) const {
    const auto found = clients_.find(client);
    return found != clients_.end() && found->second.pending != 0;
  }
  /// One line, any bytes. Each command is answered exactly once, by the number in front of it.
  void command(int client, std::string_view line);
  /// The same of a line that waited while nobody served: it is refused, whatever it says.
  void refuse_waited(int client, std::string_view line, Time waited);
  /// A line was so long that it was dropped.
  void refuse_long_line(int client);

  void take(const Reply& reply) override;
  void hear(const Event& event) override;
  void see(const ImageView& image) override;

 private:
  struct Client {
    std::uint32_t node = 0;  // 0: no default
    Time sdo_timeout{};      // 0: the node's own
    bool tells_bootups = true;
    std::size_t pending = 0;
  };
  struct Pending {
    int client = -1;  // -1: it has left
    AsciiCommand command;
  };
  using Answer = std::expected<std::string, AsciiError>;

  void run(int client, Client& state, const AsciiCommand& command);
  void finish(int client, std::uint32_t sequence, const Answer& answer);
  void refuse(int client, const AsciiRefusal& refusal);
  bool address(int client, const Client& state, const AsciiCommand& command, std::uint32_t& node);
  void submit(int client, Client& state, AsciiCommand command, Request request);
  void submit_lss(int client, Client& state, const AsciiCommand& command);
  Answer read_pdo(std::uint32_t node, const AsciiCommand& command) const;
  void write_pdo(int client, std::uint32_t node, const AsciiCommand& command);
  void follow_all_nodes(Pending pending, const Reply& reply);
  void tell_all(const std::string& line, bool bootup = false);

  const BusPlan& plan_;
  AsciiPorts ports_;
  std::map<int, Client> clients_;
  std::unordered_map<std::uint64_t, Pending> pending_;
  std::uint64_t next_id_ = 1;
  std::vector<std::int64_t> values_;  // of the newest image
  std::vector<std::uint64_t> stale_;
};

}  // namespace takt
