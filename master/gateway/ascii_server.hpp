#pragma once
#include <expected>
#include <functional>
#include <memory>
#include <poll.h>
#include <string>
#include <string_view>
#include <vector>

#include "master/gateway/time_budget.hpp"
#include "master/linux/clock.hpp"
#include "master/linux/file_descriptor.hpp"

namespace takt {

/// Lines of text from and to clients of a UNIX socket, or of TCP on loopback. Everything is
/// bounded: clients, the length of a line, what waits to be sent, the time of each serve(). A
/// client whose first line is no command of CiA 309-3 is closed before anything of it is handed
/// over, and one that gives no command within 2 s is closed, too. No call waits. One thread.
class AsciiServer {
 public:
  static constexpr std::size_t most_clients = 8;
  static constexpr std::size_t longest_line = 4096;
  static constexpr Time first_line_limit = std::chrono::seconds{2};
  static constexpr std::size_t most_unsent = 256 * 1024;  ///< a client that reads no more is left

  struct Handler {
    std::function<void(int client)> connected;
    std::function<void(int client, std::string_view line)> line;
    std::function<void(int client, std::string_view line)> old_line;  ///< see mark_waiting()
    std::function<void(int client)> too_long;                         ///< a line, which is dropped
    std::function<void(int client)> gone;
    /// An answer is on its way: a client that writes no more is kept until it has it.
    std::function<bool(int client)> owed;
  };

  /// `unix:PATH` or `tcp:PORT` (0: any free one). An error is a sentence.
  static std::expected<std::unique_ptr<AsciiServer>, std::string> listen(
      const std::string& where, Handler handler, FrontClock clock = monotonic_now);
  ~AsciiServer();
  AsciiServer(const AsciiServer&) = delete;
  AsciiServer& operator=(const AsciiServer&) = delete;

  /// Adds the end of the line. To a client that has gone: nothing.
  void send(int client, std::string_view line);
  /// Nobody has served for long: every line that has begun to arrive by now is an old one.
  void mark_waiting();
  /// Takes clients and lines, sends what can be sent.
  void serve();
  void watch(std::vector<pollfd>& descriptors) const;
  /// As others write it: "unix:/run/takt.sock", "tcp:127.0.0.1:7711".
  const std::string& where() const noexcept { return where_; }

 private:
  struct Client {
    int id = 0;
    FileDescriptor socket;
    Time since{};  // when it connected
    std::string unread;
    std::string unsent;
    std::size_t old = 0;  // bytes, of `unread` and then of the socket, that are to be old lines
    bool has_commanded = false;
    bool unhandled = false;  // whole lines wait for the next round
    bool skips = false;      // the rest of a line that was too long
    bool ended = false;      // it writes no more
    bool closed = false;
  };

  AsciiServer(FileDescriptor listener, std::string where, std::string path)
      : listener_{std::move(listener)}, where_{std::move(where)}, path_{std::move(path)} {}
  static std::expected<std::unique_ptr<AsciiServer>, std::string> listen_unix(
      const std::string& path);
  static std::expected<std::unique_ptr<AsciiServer>, std::string> listen_tcp(
      const std::string& port);
  void accept_clients();
  bool displace_silent();
  void receive_all();
  void receive(Client& client, const TimeBudget& budget);
  void take_lines(Client& client, const TimeBudget& budget);
  void take_line(Client& client, std::string_view line);
  void drop_long_line(Client& client);
  void close_foreign(Client& client);
  void close_silent(Client& client);
  void remove_closed();
  static void flush(Client& client);
  bool is_through(const Client& client) const;

  FileDescriptor listener_;
  std::string where_;
  std::string path_;  // to remove at the end
  Handler handler_{};
  FrontClock clock_{};
  std::vector<std::unique_ptr<Client>> clients_;  // oldest first
  std::size_t turn_ = 0;                          // of the client that is served first
  int next_id_ = 1;
};

}  // namespace takt
