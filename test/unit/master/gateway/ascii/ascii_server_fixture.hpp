#pragma once
#include <algorithm>
#include <gtest/gtest.h>
#include <string>
#include <sys/socket.h>
#include <unistd.h>
#include <vector>

#include "master/gateway/ascii/ascii_server.hpp"
#include "master/linux/unix_bus/unix_address.hpp"
#include "test/support/folder.hpp"
#include "test/support/step_clock.hpp"

namespace takt {

class AsciiServerTest : public testing::Test {
 protected:
  AsciiServer::Handler handler() {
    return {.connected = [this](int client) { connected.push_back(client); },
            .line = [this](int, std::string_view line) { lines.emplace_back(line); },
            .old_line =
                [this](int, std::string_view line, Time gap) {
                  old_lines.emplace_back(line);
                  gaps.push_back(gap);
                },
            .too_long = [this](int) { ++too_long; },
            .gone = [this](int client) { gone.push_back(client); },
            .awaits_reply = [this](int) { return awaits_reply; },
            .warn = [this](const std::string& sentence) { warnings.push_back(sentence); }};
  }
  void listen() {
    auto opened = AsciiServer::listen("unix:" + path_, handler(), clock);
    ASSERT_TRUE(opened) << opened.error();
    server = std::move(*opened);
  }
  FileDescriptor connect() {
    FileDescriptor socket{::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)};
    const auto address = unix_address(path_);
    if (::connect(socket.get(), reinterpret_cast<const sockaddr*>(&*address), sizeof *address) !=
        0) {
      return {};
    }
    serve();
    return socket;
  }
  /// Returns the number of descriptors that wake the server.
  std::size_t watched() const {
    std::vector<pollfd> descriptors;
    server->watch(descriptors);
    return descriptors.size();
  }
  /// Waits for something to do, then does it.
  void serve() {
    std::vector<pollfd> descriptors;
    server->watch(descriptors);
    ::poll(descriptors.data(), descriptors.size(), 5000);
    server->serve();
  }
  static void write(const FileDescriptor& socket, std::string_view text) {
    ASSERT_EQ(::send(socket.get(), text.data(), text.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(text.size()));
  }
  static std::string read(const FileDescriptor& socket) {
    char text[256];
    const ssize_t size = ::recv(socket.get(), text, sizeof text, 0);
    return {text, size > 0 ? static_cast<std::size_t>(size) : 0};
  }

  const test::Folder folder_;
  const std::string path_ = folder_ / "gateway";
  test::StepClock clock{std::chrono::microseconds{50}};
  std::unique_ptr<AsciiServer> server;
  std::vector<std::string> old_lines;
  std::vector<Time> gaps;  // of the old lines
  std::vector<std::string> lines;
  std::vector<std::string> warnings;
  std::vector<int> connected;
  std::vector<int> gone;
  int too_long = 0;
  bool awaits_reply = false;
};

}  // namespace takt
