#pragma once
#include <cstdint>
#include <expected>
#include <functional>
#include <memory>
#include <optional>
#include <poll.h>
#include <string>
#include <string_view>
#include <vector>

#include "master/lcm/accept_pause.hpp"
#include "master/lcm/front_budget.hpp"
#include "master/linux/clock.hpp"
#include "master/linux/file_descriptor.hpp"

namespace takt {

/// Exchanges lines of text with clients of a UNIX socket, or of TCP on loopback. Everything is
/// bounded: the number of clients, the length of a line, the unsent bytes and the time of each
/// serve(). The server closes a client whose first line is not a command of CiA 309-3 before it
/// hands over anything from it. It also closes a client that gives no command within 2 s. No call
/// waits. All calls come from one thread.
class AsciiServer {
 public:
  static constexpr std::size_t most_clients = 8;
  static constexpr std::size_t longest_line = 4096;
  static constexpr Time first_line_limit = std::chrono::seconds{2};
  /// A client with more unsent bytes is closed.
  static constexpr std::size_t most_unsent = 256 * 1024;

  struct Handler {
    std::function<void(int client)> connected;
    std::function<void(int client, std::string_view line)> line;
    /// Receives the lines that mark_waiting() has marked as old. `gap` is the longest gap in which
    /// the line may have waited.
    std::function<void(int client, std::string_view line, Time gap)> old_line;
    /// Reports that a client has sent a line that was too long and was dropped.
    std::function<void(int client)> too_long;
    std::function<void(int client)> gone;
    /// Returns true if an answer is due: a client that has ended its writing side stays until it
    /// has the answer.
    std::function<bool(int client)> awaits_reply;
    /// Receives a sentence for the user about a problem of the server itself, at most once in 10 s.
    std::function<void(const std::string& sentence)> warn = [](const std::string&) {};
  };

  /// `where` is `unix:PATH` or `tcp:PORT` (port 0 selects any free port). The error is a sentence.
  static std::expected<std::unique_ptr<AsciiServer>, std::string> listen(
      const std::string& where, Handler handler, FrontClock clock = monotonic_now);
  ~AsciiServer();
  AsciiServer(const AsciiServer&) = delete;
  AsciiServer& operator=(const AsciiServer&) = delete;

  /// Sends a line and adds its end. Does nothing if the client has gone.
  void send(int client, std::string_view line);
  /// Notes that the front thread did not run for `gap`. Every line that has begun to arrive by now
  /// counts as old.
  void mark_waiting(Time gap);
  /// Accepts clients, takes their lines and sends as much as possible.
  void serve();
  void watch(std::vector<pollfd>& descriptors) const;
  /// Returns the address as other programs write it: "unix:/run/takt.sock", "tcp:127.0.0.1:7711".
  const std::string& where() const noexcept { return where_; }

 private:
  /// Identifies a file independently of its name.
  struct FileId {
    std::uint64_t device = 0;
    std::uint64_t inode = 0;
    bool operator==(const FileId&) const = default;
  };
  struct Client {
    int id = 0;
    FileDescriptor socket;
    Time since{};  // time of the connection
    std::string unread;
    std::string unsent;
    std::size_t old = 0;  // bytes that belong to old lines, first in `unread`, then in the socket
    Time gap{};           // the longest gap in which these bytes may have waited
    bool has_commanded = false;
    bool unhandled = false;  // whole lines wait for the next round
    bool skips = false;      // the rest of a line that was too long is skipped
    bool ended = false;      // the client has closed its writing side
    bool closed = false;
  };

  AsciiServer(FileDescriptor listener, std::string where, std::string path)
      : listener_{std::move(listener)}, where_{std::move(where)}, path_{std::move(path)} {}
  static std::expected<std::unique_ptr<AsciiServer>, std::string> listen_unix(
      const std::string& path);
  static std::expected<std::unique_ptr<AsciiServer>, std::string> listen_tcp(
      const std::string& port);
  static std::optional<FileId> file_at(const std::string& path);
  void accept_clients();
  bool displace_silent();
  void receive_all();
  void receive(Client& client, const FrontBudget& budget);
  void take_lines(Client& client, const FrontBudget& budget);
  void take_line(Client& client, std::string_view line);
  void drop_long_line(Client& client);
  void close_foreign(Client& client);
  void close_silent(Client& client);
  void remove_closed();
  static void flush(Client& client);
  bool is_through(const Client& client) const;

  FileDescriptor listener_;
  std::string where_;
  std::string path_;
  std::optional<FileId> own_file_;  // socket at `path_` to remove at the end
  Handler handler_{};
  FrontClock clock_{};
  std::vector<std::unique_ptr<Client>> clients_;  // oldest first
  std::size_t turn_ = 0;                          // index of the client served first
  int next_id_ = 1;
  AcceptPause accept_pause_;
};

}  // namespace takt
