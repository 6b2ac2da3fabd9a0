#include "master/gateway/ascii/ascii_server.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <utility>

#include "eds_parser/values/number_in.hpp"
#include "master/gateway/ascii/ascii_command.hpp"
#include "master/linux/left_socket.hpp"
#include "master/linux/tcp_loopback.hpp"
#include "master/linux/unix_bus/unix_address.hpp"

namespace takt {
namespace {

std::unexpected<std::string> failed(const std::string& where, int error) {
  return std::unexpected{"--gateway " + where + ": " + std::strerror(error)};
}

}  // namespace

std::expected<std::unique_ptr<AsciiServer>, std::string> AsciiServer::listen(
    const std::string& where, Handler handler, FrontClock clock) {
  const bool is_unix = where.starts_with("unix:");
  if (!is_unix && !where.starts_with("tcp:")) {
    return std::unexpected{"--gateway '" + where + "' is not unix:PATH or tcp:PORT"};
  }
  auto server = is_unix ? listen_unix(where.substr(5)) : listen_tcp(where.substr(4));
  if (!server) return server;
  (*server)->handler_ = std::move(handler);
  (*server)->clock_ = std::move(clock);
  return server;
}

std::expected<std::unique_ptr<AsciiServer>, std::string> AsciiServer::listen_unix(
    const std::string& path) {
  const auto address = unix_address(path);
  if (!address) {
    return std::unexpected{"--gateway unix:" + path + ": a path has 1 to 107 characters"};
  }
  if (!remove_left_socket(*address)) return failed("unix:" + path, EADDRINUSE);
  FileDescriptor socket{::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)};
  const auto* generic = reinterpret_cast<const sockaddr*>(&*address);
  if (!socket || ::bind(socket.get(), generic, sizeof *address) != 0 ||
      ::chmod(path.c_str(), 0660) != 0 || ::listen(socket.get(), 8) != 0) {
    return failed("unix:" + path, errno);
  }
  std::unique_ptr<AsciiServer> server{new AsciiServer{std::move(socket), "unix:" + path, path}};
  server->own_file_ = file_at(path);
  return server;
}

std::expected<std::unique_ptr<AsciiServer>, std::string> AsciiServer::listen_tcp(
    const std::string& text) {
  const auto port = number_in<std::uint16_t>(text);
  if (!port) return std::unexpected{"--gateway tcp:" + text + ": a port is 0..65535"};
  auto listener = listen_on_loopback(*port);
  if (!listener) return failed("tcp:" + text, listener.error());
  const std::string where = "tcp:127.0.0.1:" + std::to_string(listener->port);
  return std::unique_ptr<AsciiServer>{new AsciiServer{std::move(listener->socket), where, {}}};
}

std::optional<AsciiServer::FileId> AsciiServer::file_at(const std::string& path) {
  struct stat found{};
  if (lstat(path.c_str(), &found) != 0) return std::nullopt;
  return FileId{.device = found.st_dev, .inode = found.st_ino};
}

/// Removes the socket file, unless another program has replaced it meanwhile.
AsciiServer::~AsciiServer() {
  if (own_file_ && file_at(path_) == own_file_) ::unlink(path_.c_str());
}

void AsciiServer::accept_clients() {
  const Time now = clock_();
  for (std::size_t i = 0; i < most_clients && !accept_pause_.active(now); ++i) {
    auto socket = accept_pause_.accept(listener_.get(), now);
    if (!socket && !socket.error().empty()) handler_.warn("CiA 309-3 gateway: " + socket.error());
    if (!socket) return;
    if (clients_.size() == most_clients && !displace_silent()) continue;
    auto client = std::make_unique<Client>();
    client->id = next_id_++;
    client->since = clock_();
    client->socket = std::move(*socket);
    clients_.push_back(std::move(client));
    handler_.connected(clients_.back()->id);
  }
}

/// Closes the oldest client that has given no command yet, to make room for a new one. Returns
/// false if there is none.
bool AsciiServer::displace_silent() {
  const auto silent = std::ranges::find(clients_, false, &Client::has_commanded);
  if (silent == clients_.end()) return false;
  (*silent)->closed = true;
  remove_closed();
  return true;
}

void AsciiServer::send(int id, std::string_view line) {
  const auto found = std::ranges::find(clients_, id, [](const auto& client) { return client->id; });
  if (found == clients_.end() || (*found)->closed) return;
  Client& client = **found;
  if (client.unsent.size() + line.size() + 2 > most_unsent) {
    client.closed = true;
    return;
  }
  client.unsent.append(line).append("\r\n");
  flush(client);
}

void AsciiServer::flush(Client& client) {
  while (!client.closed && !client.unsent.empty()) {
    const ssize_t taken = ::send(client.socket.get(), client.unsent.data(), client.unsent.size(),
                                 MSG_NOSIGNAL | MSG_DONTWAIT);
    if (taken < 0) {
      client.closed = !would_wait(errno);
      return;
    }
    client.unsent.erase(0, static_cast<std::size_t>(taken));
  }
}

void AsciiServer::receive(Client& client, const FrontBudget& budget) {
  std::array<char, 4096> chunk;
  take_lines(client, budget);
  while (!client.closed && !client.ended && !client.unhandled) {
    const ssize_t size = ::recv(client.socket.get(), chunk.data(), chunk.size(), MSG_DONTWAIT);
    if (size <= 0) {
      client.ended = size == 0;
      client.closed = size < 0 && !would_wait(errno);
      return close_silent(client);
    }
    client.unread.append(chunk.data(), static_cast<std::size_t>(size));
    take_lines(client, budget);
    if (!budget.is_left()) return;
  }
}

/// Takes whole lines. Lines for which the budget has no time left wait in `unread`.
void AsciiServer::take_lines(Client& client, const FrontBudget& budget) {
  std::size_t from = 0;
  client.unhandled = false;
  for (std::size_t end = client.unread.find('\n'); end != std::string::npos && !client.closed;
       end = client.unread.find('\n', from)) {
    client.unhandled = from != 0 && !budget.is_left();
    if (client.unhandled) break;
    take_line(client, std::string_view{client.unread}.substr(from, end - from));
    client.old -= std::min(client.old, end + 1 - from);
    from = end + 1;
  }
  client.unread.erase(0, from);
  if (client.closed || client.unhandled) return;
  if (!client.has_commanded && !may_become_command(client.unread)) return close_foreign(client);
  if (client.unread.size() <= longest_line) return;
  if (!std::exchange(client.skips, true)) drop_long_line(client);
  client.old -= std::min(client.old, client.unread.size());
  client.unread.clear();
}

void AsciiServer::take_line(Client& client, std::string_view line) {
  if (std::exchange(client.skips, false)) return;
  if (line.size() > longest_line) return drop_long_line(client);
  if (!client.has_commanded) {
    const FirstLine first = judge_first_line(line);
    if (first == FirstLine::foreign) return close_foreign(client);
    client.has_commanded = first == FirstLine::command;
  }
  if (client.old != 0) return handler_.old_line(client.id, line, client.gap);
  handler_.line(client.id, line);
}

void AsciiServer::mark_waiting(Time gap) {
  accept_clients();
  for (const auto& client : clients_) {
    int in_socket = 0;
    if (::ioctl(client->socket.get(), FIONREAD, &in_socket) != 0) in_socket = 0;
    client->gap = client->old == 0 ? gap : std::max(client->gap, gap);
    client->old = client->unread.size() + static_cast<std::size_t>(in_socket);
  }
}

void AsciiServer::drop_long_line(Client& client) {
  if (!client.has_commanded) return close_foreign(client);
  handler_.too_long(client.id);
}

/// Closes a client that speaks another protocol. Such a client, for example a web page, must not
/// command a machine by accident.
void AsciiServer::close_foreign(Client& client) {
  send(client.id,
       "[0] ERROR: 101 (syntax error: the first line is no command of CiA 309-3, such as '[1] "
       "help'; the connection is closed)");
  client.unread.clear();
  client.closed = true;
}

/// Closes a client that has given no command in time, so that another client gets its place.
/// Everything that the client has sent was read before.
void AsciiServer::close_silent(Client& client) {
  const bool waits = !client.closed && !client.ended && !client.has_commanded;
  if (!waits || clock_() - client.since < first_line_limit) return;
  send(client.id,
       "[0] ERROR: 101 (no command came within 2 s, such as '[1] help'; the connection is closed)");
  client.closed = true;
}

/// Returns true if the client has closed its writing side and will read nothing more.
bool AsciiServer::is_through(const Client& client) const {
  if (!client.ended) return false;
  pollfd state{.fd = client.socket.get(), .events = 0, .revents = 0};
  if (::poll(&state, 1, 0) == 1) return true;  // the client has closed its reading side as well
  return client.unsent.empty() && !handler_.awaits_reply(client.id);
}

void AsciiServer::serve() {
  accept_clients();
  receive_all();
  remove_closed();
}

/// If the budget ends before all clients are served, the next round begins with the next client.
void AsciiServer::receive_all() {
  const FrontBudget budget{clock_, FrontBudget::gateway};
  const std::size_t count = clients_.size();
  if (turn_ >= count) turn_ = 0;
  const std::size_t first = turn_;
  for (std::size_t i = 0; i < count; ++i) {
    Client& client = *clients_[(first + i) % count];
    flush(client);
    receive(client, budget);
    client.closed |= is_through(client);
    turn_ = (first + i + 1) % count;
    if (!budget.is_left()) return;
  }
}

void AsciiServer::remove_closed() {
  for (const auto& client : clients_) {
    if (client->closed) handler_.gone(client->id);
  }
  std::erase_if(clients_, [](const auto& client) { return client->closed; });
}

/// Lists the descriptors to wait for. For clients whose lines wait for the next round, POLLOUT ends
/// the wait at once.
void AsciiServer::watch(std::vector<pollfd>& descriptors) const {
  if (!accept_pause_.active(clock_())) {
    descriptors.push_back({.fd = listener_.get(), .events = POLLIN, .revents = 0});
  }
  for (const auto& client : clients_) {
    const bool out = client->unhandled || !client->unsent.empty();
    const int events = (client->ended ? 0 : POLLIN) | (out ? POLLOUT : 0);
    descriptors.push_back(
        {.fd = client->socket.get(), .events = static_cast<short>(events), .revents = 0});
  }
}

}  // namespace takt
