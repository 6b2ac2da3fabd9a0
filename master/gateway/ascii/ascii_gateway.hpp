#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"
#include "master/gateway/ascii/ascii_command.hpp"
#include "master/gateway/front_guest.hpp"

namespace takt {

/// The actions of the gateway on the bus and its clients.
struct AsciiPorts {
  /// Hands a request to the bus thread. Returns false if the bus thread has too many requests.
  std::function<bool(const Request&)> submit;
  /// Commands outputs. Returns false if they are refused; an event reports the refusal, except for
  /// commands that may have waited during a gap of the front thread.
  std::function<bool(const std::vector<SignalIndex>&, const std::vector<std::int64_t>&)> write;
  /// Sends one line (without its end) to one client.
  std::function<void(int client, const std::string& line)> send;
};

/// The gateway of CiA 309-3 turns text commands of clients into requests, and replies and events
/// into lines. It has one network, with the number 1. It does not know sockets. All calls come from
/// the front thread.
class AsciiGateway final : public FrontGuest {
 public:
  static constexpr std::size_t most_pending = 16;  ///< most unanswered commands of one client

  AsciiGateway(const BusPlan& plan, AsciiPorts ports);

  void connect(int client) { clients_[client] = {}; }
  void disconnect(int client);
  /// Returns true if a command of this client is still unanswered.
  bool awaits_reply(int client) const {
    const auto found = clients_.find(client);
    return found != clients_.end() && found->second.pending != 0;
  }
  /// Takes one line of any bytes. Each command gets exactly one answer, under the number in front
  /// of the command.
  void command(int client, std::string_view line);
  /// Refuses a line that waited while the front thread did not run for `gap`, whatever the line
  /// says.
  void refuse_waited(int client, std::string_view line, Time gap);
  /// Refuses a line that waited while the front thread did not run for `gap`, if the line sets
  /// outputs. Takes any other line.
  void refuse_waited_outputs(int client, std::string_view line, Time gap);
  /// Answers a line that was dropped because it was too long.
  void refuse_long_line(int client);

  void take(const Reply& reply) override;
  void hear(const Event& event) override;
  void see(const ImageView& image) override;

 private:
  struct Client {
    std::uint32_t node = 0;  // 0 means no default
    Time sdo_timeout{};      // 0 selects the time-out of the node
    bool reports_bootups = true;
    std::size_t pending = 0;
  };
  struct Pending {
    int client = -1;  // -1 if the client has left
    AsciiCommand command;
  };
  using Answer = std::expected<std::string, AsciiError>;

  void run(int client, Client& state, const AsciiCommand& command);
  void finish(int client, std::uint32_t sequence, const Answer& answer);
  void refuse(int client, const AsciiRefusal& refusal);
  /// Returns the node that a command is for.
  static std::expected<std::uint32_t, AsciiError> address(const Client& state,
                                                          const AsciiCommand& command);
  void submit(int client, Client& state, AsciiCommand command, Request request);
  void submit_lss(int client, Client& state, const AsciiCommand& command);
  Answer read_pdo(std::uint32_t node, const AsciiCommand& command) const;
  void write_pdo(int client, std::uint32_t node, const AsciiCommand& command);
  void follow_all_nodes(Pending pending, const Reply& reply);
  void report_all(const std::string& line, bool bootup = false);

  const BusPlan& plan_;
  AsciiPorts ports_;
  std::map<int, Client> clients_;
  std::unordered_map<std::uint64_t, Pending> pending_;
  std::uint64_t next_id_ = 1;
  std::vector<std::int64_t> values_;  // values of the newest image
  std::vector<std::uint64_t> stale_;
};

}  // namespace takt
