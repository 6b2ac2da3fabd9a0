#include "master/linux/unix_bus/unix_bus_hub.hpp"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <sys/eventfd.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <thread>
#include <vector>

#include "master/linux/clock.hpp"
#include "master/linux/file_descriptor.hpp"
#include "master/linux/left_socket.hpp"
#include "master/linux/message_batch.hpp"
#include "master/linux/start_thread.hpp"
#include "master/linux/transient_error.hpp"
#include "master/linux/unix_bus/unix_address.hpp"
#include "master/linux/unix_bus/unix_bus_record.hpp"

namespace takt {
namespace {

constexpr std::size_t max_clients = 64;
constexpr std::size_t client_batch_frames = 64;
constexpr int takeover_poll_ms = 20;
/// While the path is taken, a program repeats its attempt this often at its start.
constexpr int most_takeovers = 25;
/// After an accept() that failed, for example because no descriptor is left, the client waits in
/// the kernel, and the hub does not poll the listening socket for this time.
constexpr Time accept_pause = std::chrono::milliseconds{100};
constexpr int most_batches = 4096;  // most batches of one client that hand_over() forwards

struct Client {
  FileDescriptor socket;
  std::uint32_t lost = 0;
  bool gone = false;
};

void enlarge_send_buffer(int fd) noexcept {
  const int bytes = 4 << 20;
  if (setsockopt(fd, SOL_SOCKET, SO_SNDBUFFORCE, &bytes, sizeof bytes) != 0) {
    setsockopt(fd, SOL_SOCKET, SO_SNDBUF, &bytes, sizeof bytes);
  }
}

/// Describes why bind() or listen() failed.
std::string refusal(const std::string& path, int error) {
  struct stat found{};
  if (error != EADDRINUSE || lstat(path.c_str(), &found) != 0) {
    return std::string{"cannot listen: "} + std::strerror(error);
  }
  if (S_ISSOCK(found.st_mode)) {
    return "another program listens there, and it is not a bus of takt; the bus needs its own path";
  }
  return "another file of this name exists already and takt does not change it; the bus needs its "
         "own path";
}

}  // namespace

class UnixBusHub::Impl {
 public:
  Impl(FileDescriptor lock, FileDescriptor stop, sockaddr_un address)
      : lock_{std::move(lock)}, stop_{std::move(stop)}, address_{address} {}
  ~Impl() {
    if (!thread_.joinable()) return;
    const std::uint64_t one = 1;
    if (write(stop_.get(), &one, sizeof one) == sizeof one) thread_.join();
  }

  /// Begins to host the bus. Returns false if another process hosts. The error is the errno of
  /// bind() or listen().
  std::expected<bool, int> try_to_host();
  /// Hosts or joins the bus. If a host was just killed, the kernel may have released its lock but
  /// not closed its socket yet; the function then tries again.
  std::expected<bool, int> host_or_join();
  /// Starts the thread. The error is the errno that says why it could not be created.
  std::expected<void, int> start() {
    auto thread = start_thread([this] { run(); });
    if (!thread) return std::unexpected{thread.error()};
    thread_ = std::move(*thread);
    return {};
  }
  bool hosting() const noexcept { return hosting_.load(std::memory_order_relaxed); }

 private:
  void run();
  bool stopping(int timeout_ms);
  void serve();
  void hand_over();
  bool accept_client();
  void forward_from(Client& sender);
  void deliver(Client& receiver, bool own, std::size_t count);

  FileDescriptor lock_;
  FileDescriptor stop_;
  FileDescriptor listener_;
  sockaddr_un address_;
  Time accept_again_{};
  std::vector<Client> clients_;
  MessageBatch<UnixBusRecord, client_batch_frames, 0> in_;
  MessageBatch<UnixBusRecord, client_batch_frames, 0> out_;
  std::atomic<bool> hosting_{false};
  std::thread thread_;
};

std::expected<bool, int> UnixBusHub::Impl::try_to_host() {
  if (flock(lock_.get(), LOCK_EX | LOCK_NB) != 0) return false;
  FileDescriptor listener{socket(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)};
  const auto* address = reinterpret_cast<const sockaddr*>(&address_);
  // This process holds the lock, so that no other bus of takt listens there.
  if (!listener || !remove_left_socket(address_)) {
    const int error = listener ? EADDRINUSE : errno;
    flock(lock_.get(), LOCK_UN);
    return std::unexpected{error};
  }
  if (bind(listener.get(), address, sizeof address_) != 0 ||
      listen(listener.get(), static_cast<int>(max_clients)) != 0) {
    const int error = errno;
    flock(lock_.get(), LOCK_UN);
    return std::unexpected{error};
  }
  listener_ = std::move(listener);
  hosting_.store(true, std::memory_order_relaxed);
  return true;
}

std::expected<bool, int> UnixBusHub::Impl::host_or_join() {
  auto hosts = try_to_host();
  for (int i = 0; i < most_takeovers && !hosts && hosts.error() == EADDRINUSE; ++i) {
    if (stopping(takeover_poll_ms)) break;
    hosts = try_to_host();
  }
  return hosts;
}

bool UnixBusHub::Impl::stopping(int timeout_ms) {
  pollfd stop{.fd = stop_.get(), .events = POLLIN, .revents = 0};
  return poll(&stop, 1, timeout_ms) > 0;
}

void UnixBusHub::Impl::run() {
  pthread_setname_np(pthread_self(), "takt-hub");
  while (!hosting()) {
    if (stopping(takeover_poll_ms)) return;
    const auto hosts = try_to_host();
    if (!hosts && hosts.error() != EADDRINUSE && !is_transient_error(hosts.error())) return;
  }
  serve();
  hand_over();
}

void UnixBusHub::Impl::serve() {
  std::vector<pollfd> polled;
  for (;;) {
    polled.clear();
    polled.push_back({.fd = stop_.get(), .events = POLLIN, .revents = 0});
    const Time pause = std::max(Time{}, accept_again_ - monotonic_now());
    const short awaited = pause > Time{} ? 0 : POLLIN;
    polled.push_back({.fd = listener_.get(), .events = awaited, .revents = 0});
    for (const Client& client : clients_) {
      polled.push_back({.fd = client.socket.get(), .events = POLLIN, .revents = 0});
    }
    const timespec limit = to_timespec(pause);
    const timespec* const at_most = pause > Time{} ? &limit : nullptr;
    if (ppoll(polled.data(), polled.size(), at_most, nullptr) < 0 && errno != EINTR) return;
    if (polled[0].revents != 0) return;
    for (std::size_t i = 0; i < clients_.size(); ++i) {
      if (polled[i + 2].revents != 0) forward_from(clients_[i]);
    }
    if (polled[1].revents != 0) accept_client();
    std::erase_if(clients_, [](const Client& client) { return client.gone; });
  }
}

/// Ends the service of this host. Frames that clients have already sent still reach the others; the
/// kernel refuses what they send from now on.
void UnixBusHub::Impl::hand_over() {
  while (accept_client()) {
  }
  listener_.reset();
  for (const Client& client : clients_) shutdown(client.socket.get(), SHUT_RD);
  for (Client& sender : clients_) {
    const bool was_gone = sender.gone;
    for (int batch = 0; batch < most_batches && !sender.gone; ++batch) forward_from(sender);
    sender.gone = was_gone;
  }
}

/// Returns false if no client is waiting, or if it can't be accepted now.
bool UnixBusHub::Impl::accept_client() {
  FileDescriptor socket{accept4(listener_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC)};
  if (!socket) {
    const bool nobody_waits = errno == EAGAIN || errno == EINTR || errno == ECONNABORTED;
    if (!nobody_waits) accept_again_ = monotonic_now() + accept_pause;
    return false;
  }
  if (clients_.size() == max_clients) return true;
  enlarge_send_buffer(socket.get());
  clients_.push_back({.socket = std::move(socket)});
  return true;
}

/// Forwards the frames of a client to all others. A client that ends with unread frames resets its
/// connection; the frames that it has sent can still be read after that error.
void UnixBusHub::Impl::forward_from(Client& sender) {
  const int got = in_.receive(sender.socket.get(), client_batch_frames);
  if (got < 0) {
    sender.gone = errno != EAGAIN && errno != EINTR && errno != ECONNRESET;
    return;
  }
  const std::int64_t now = monotonic_now().count();
  std::size_t count = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(got); ++i) {
    if (in_.bytes(i) == 0) sender.gone = true;  // end of file
    if (in_.bytes(i) != sizeof(UnixBusRecord) || !valid(in_.record(i))) continue;
    UnixBusRecord& record = out_.record(count++);
    record = in_.record(i);
    record.when = now;
  }
  for (Client& receiver : clients_) {
    if (!receiver.gone || &receiver == &sender) deliver(receiver, &receiver == &sender, count);
  }
}

/// Sends the batch to a receiver. A receiver that has ended is kept until all frames that it has
/// sent are read.
void UnixBusHub::Impl::deliver(Client& receiver, bool own, std::size_t count) {
  if (count == 0) return;
  for (std::size_t i = 0; i < count; ++i) {
    out_.record(i).own = own ? 1 : 0;
    out_.record(i).lost = receiver.lost;
  }
  const int sent = out_.send(receiver.socket.get(), 0, count);
  receiver.lost += static_cast<std::uint32_t>(count - static_cast<std::size_t>(std::max(sent, 0)));
}

UnixBusHub::UnixBusHub(std::unique_ptr<Impl> impl) noexcept : impl_{std::move(impl)} {}
UnixBusHub::UnixBusHub(UnixBusHub&&) noexcept = default;
UnixBusHub& UnixBusHub::operator=(UnixBusHub&&) noexcept = default;
UnixBusHub::~UnixBusHub() = default;

bool UnixBusHub::hosting() const noexcept { return impl_->hosting(); }

std::expected<UnixBusHub, BusError> UnixBusHub::join(const std::string& path) {
  const auto refuse = [&path](const std::string& what, int error) {
    return std::unexpected{BusError{"unix:" + path + ": " + what, error}};
  };
  const auto refuse_with = [&refuse](const std::string& what, int error) {
    return refuse(what + ": " + std::strerror(error), error);
  };
  const auto address = unix_address(path);
  if (!address) return refuse_with("a path of 1 to 107 bytes is needed", ENAMETOOLONG);
  const std::string lock_path = path + ".lock";
  constexpr int flags = O_RDWR | O_CREAT | O_CLOEXEC;
  FileDescriptor lock{::open(lock_path.c_str(), flags | O_EXCL, 0666)};
  const bool is_new = static_cast<bool>(lock);
  if (!lock && errno == EEXIST) lock.reset(::open(lock_path.c_str(), flags, 0666));
  if (!lock) return refuse_with("cannot create the lock file beside the socket", errno);
  FileDescriptor stop{eventfd(0, EFD_CLOEXEC)};
  if (!stop) return refuse_with("eventfd", errno);
  auto impl = std::make_unique<Impl>(std::move(lock), std::move(stop), *address);
  if (const auto hosts = impl->host_or_join(); !hosts) {
    if (is_new) unlink(lock_path.c_str());
    return refuse(refusal(path, hosts.error()), hosts.error());
  }
  if (const auto started = impl->start(); !started) {
    return refuse_with("no thread can be created", started.error());
  }
  return UnixBusHub{std::move(impl)};
}

}  // namespace takt
