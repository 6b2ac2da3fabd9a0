// A host without free descriptors.
#include <atomic>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

#include "master/linux/clock.hpp"
#include "master/linux/file_descriptor.hpp"
#include "master/linux/unix_bus/unix_address.hpp"
#include "master/linux/unix_bus/unix_bus_hub.hpp"
#include "test/support/no_descriptor_left.hpp"
#include "test/unit/master/linux/unix_bus/unix_bus_fixture.hpp"

namespace {

// calls that failed with EMFILE
std::atomic<int> refused_clients = 0;
std::atomic<int> refused_sockets = 0;

}  // namespace

// These functions replace those of the C library in this test program.
extern "C" int accept4(int fd, sockaddr* address, socklen_t* size, int flags) {
  const auto accepted = static_cast<int>(::syscall(SYS_accept4, fd, address, size, flags));
  if (accepted < 0 && errno == EMFILE) ++refused_clients;
  return accepted;
}
extern "C" int socket(int domain, int type, int protocol) noexcept {
  const auto made = static_cast<int>(::syscall(SYS_socket, domain, type, protocol));
  if (made < 0 && errno == EMFILE) ++refused_sockets;
  return made;
}

namespace takt::test {
namespace {

/// A thread of this process has given itself this name.
bool runs_thread(const std::string& wanted) {
  for (const auto& task : std::filesystem::directory_iterator{"/proc/self/task"}) {
    std::ifstream comm{task.path() / "comm"};
    std::string name;
    if (std::getline(comm, name) && name == wanted) return true;
  }
  return false;
}

TEST_F(UnixBus, AHostWithoutDescriptorsServesItsClientsAndLeavesTheNextOneWaiting) {
  constexpr Time pause = std::chrono::milliseconds{100};  // between two attempts to accept
  UnixBusPort a = port();
  UnixBusPort b = port();
  make_acquainted(a, b);
  const auto address = unix_address(path_);
  const FileDescriptor next{::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0)};
  {
    const NoDescriptorLeft none;
    const Time begin = a.now();
    const int before = refused_clients;
    ASSERT_EQ(::connect(next.get(), reinterpret_cast<const sockaddr*>(&*address), sizeof *address),
              0);
    ASSERT_TRUE(soon(a, [&] { return refused_clients > before; }));
    for (int i = 0; i < 50; ++i) {
      ASSERT_EQ(a.send({&tpdo, 1}).sent, 1U);
      ASSERT_EQ(receive_all(b, 1).size(), 1U);
    }
    EXPECT_LE(refused_clients - before, 1 + (a.now() - begin) / pause);
  }

  std::array<char, 64> record;
  EXPECT_TRUE(soon(b, [&] {
    a.send({&tpdo, 1});
    return ::recv(next.get(), record.data(), record.size(), MSG_DONTWAIT) > 0;
  })) << "it is accepted as soon as there are descriptors";
}

TEST_F(UnixBus, AHubThatStandsByWithoutDescriptorsTakesOverWhenThereAreSome) {
  int ready[2];
  ASSERT_EQ(::pipe(ready), 0);
  const pid_t host = ::fork();
  if (host == 0) {
    const auto first = UnixBusHub::join(path_);
    const char byte = first && first->hosting() ? 'y' : 'n';
    if (::write(ready[1], &byte, 1) != 1) ::_exit(1);
    for (;;) ::pause();
  }
  char byte = 0;
  ASSERT_EQ(::read(ready[0], &byte, 1), 1);
  ASSERT_EQ(byte, 'y');
  const auto second = UnixBusHub::join(path_);
  ASSERT_TRUE(second);
  const auto comes = [](const auto& condition) {
    const Time until = monotonic_now() + limit;
    while (!condition() && monotonic_now() < until) std::this_thread::yield();
    return condition();
  };
  // UBSan needs a descriptor when a thread begins.
  ASSERT_TRUE(comes([] { return runs_thread("takt-hub"); }));
  {
    const NoDescriptorLeft none;
    const int before = refused_sockets;
    ::kill(host, SIGKILL);
    ::waitpid(host, nullptr, 0);
    EXPECT_TRUE(comes([&] { return refused_sockets > before; }));
    EXPECT_FALSE(second->hosting());
  }
  EXPECT_TRUE(comes([&] { return second->hosting(); }));
  ::close(ready[0]);
  ::close(ready[1]);
}

}  // namespace
}  // namespace takt::test
