#include "apps/taktd/process/line_writer.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <fcntl.h>
#include <mutex>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

#include "master/linux/clock.hpp"
#include "master/linux/start_thread.hpp"

namespace takt {
namespace {

constexpr Time try_again = std::chrono::seconds{1};

std::uint64_t lines_in(std::string_view text) {
  return static_cast<std::uint64_t>(std::ranges::count(text, '\n'));
}

/// A terminal that nobody reads can be ready for poll() and yet accept nothing. Without this pause
/// its writer would spin.
void pause(Time longest) noexcept {
  const Time time = std::min<Time>(longest, std::chrono::milliseconds{10});
  ::poll(nullptr, 0, static_cast<int>(std::chrono::ceil<std::chrono::milliseconds>(time).count()));
}

/// Writes `text`, however long that takes. Returns how many bytes the file has accepted before an
/// error.
std::size_t write_all(int fd, std::string_view text) noexcept {
  std::size_t done = 0;
  while (done < text.size()) {
    const ssize_t written = ::write(fd, text.data() + done, text.size() - done);
    if (written > 0) done += static_cast<std::size_t>(written);
    if (written > 0 || (written < 0 && errno == EINTR)) continue;
    if (written == 0 || errno != EAGAIN) break;
    pollfd room{.fd = fd, .events = POLLOUT, .revents = 0};
    if (::poll(&room, 1, 0) > 0) pause(Time::max());
    ::poll(&room, 1, -1);
  }
  return done;
}

/// Writes what the file accepts at once, although the descriptor may be blocking. A pipe that is
/// ready accepts a short text as a whole. A terminal may be ready and yet accept nothing. Its
/// descriptor is therefore made non-blocking during this call, which other programs that share the
/// descriptor hardly notice.
ssize_t write_at_once(int fd, std::string_view text) noexcept {
  const ssize_t sent = ::send(fd, text.data(), text.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
  if (sent >= 0 || errno != ENOTSOCK) return sent;
  const int flags = ::fcntl(fd, F_GETFL);
  const bool waits = flags >= 0 && (flags & O_NONBLOCK) == 0 && ::isatty(fd) != 0;
  if (waits && ::fcntl(fd, F_SETFL, flags | O_NONBLOCK) != 0) return -1;
  const ssize_t written = ::write(fd, text.data(), text.size());
  const int error = errno;
  if (waits) ::fcntl(fd, F_SETFL, flags);
  errno = error;
  return written;
}

enum class Takes : std::uint8_t { more, nothing_now, nothing_ever };

/// Writes what the file accepts until `end` and counts the bytes in `done`.
Takes write_until(int fd, std::string_view text, Time end, std::size_t& done) noexcept {
  // A pipe that is ready accepts this number of bytes as a whole.
  constexpr std::size_t at_once = 512;
  while (done < text.size()) {
    const Time left = std::max(end - monotonic_now(), Time{0});
    const auto ms = std::chrono::ceil<std::chrono::milliseconds>(left).count();
    pollfd room{.fd = fd, .events = POLLOUT, .revents = 0};
    if (::poll(&room, 1, static_cast<int>(ms)) <= 0) return Takes::nothing_now;
    const std::string_view next = text.substr(done, at_once);
    const ssize_t written = write_at_once(fd, next);
    if (written > 0) done += static_cast<std::size_t>(written);
    if (written > 0 || (written < 0 && errno == EINTR)) continue;
    if (written == 0 || errno != EAGAIN) return Takes::nothing_ever;
    const Time rest = end - monotonic_now();
    if (rest <= Time{0}) return Takes::nothing_now;
    pause(rest);
  }
  return Takes::more;
}

/// Removes the last `bytes` of a regular file if no program has appended to it since. Returns false
/// if they could not be removed.
bool take_back(int fd, std::size_t bytes) noexcept {
  struct stat file{};
  const auto end = ::lseek(fd, 0, SEEK_CUR);
  const bool last = ::fstat(fd, &file) == 0 && S_ISREG(file.st_mode) && file.st_size == end;
  return last && ::ftruncate(fd, end - static_cast<off_t>(bytes)) == 0;
}

/// Returns true if the last line of the file has no end, because an earlier run was cut off.
bool ends_within_a_line(const std::string& path) noexcept {
  const FileDescriptor file{::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)};
  struct stat status{};
  char last = '\n';
  if (::fstat(file.get(), &status) != 0 || !S_ISREG(status.st_mode)) return false;
  return ::pread(file.get(), &last, 1, status.st_size - 1) == 1 && last != '\n';
}

}  // namespace

struct LineWriter::State {
  FileDescriptor file;  // used only by the thread, or by the caller if there is no thread
  bool cut = false;     // the file ends within a line; used by the same thread as `file`
  std::mutex mutex;     // protects all members below
  std::condition_variable changed;
  std::string waiting;  // only whole lines
  std::uint64_t lost = 0;
  bool writing = false;
  bool ends = false;

  void run();
  std::uint64_t write(std::string_view lines);
};

/// Returns the number of lines that could not be written.
std::uint64_t LineWriter::State::write(std::string_view lines) {
  if (cut && write_all(file.get(), "\n") == 1) cut = false;
  if (cut) return lines_in(lines);
  const std::size_t done = write_all(file.get(), lines);
  if (done == lines.size()) return 0;
  const std::size_t whole = lines.substr(0, done).rfind('\n') + 1;  // npos + 1 is 0
  cut = done > whole && !take_back(file.get(), done - whole);
  return lines_in(lines.substr(whole));
}

void LineWriter::State::run() {
  std::unique_lock lock{mutex};
  for (;;) {
    changed.wait(lock, [this] { return ends || !waiting.empty(); });
    if (waiting.empty()) return;
    const std::string lines = std::exchange(waiting, {});
    writing = true;
    lock.unlock();
    const std::uint64_t unwritten = write(lines);
    lock.lock();
    writing = false;
    lost += unwritten;
    changed.notify_all();
  }
}

bool LineWriter::start_detached(std::function<void()> body) {
  auto thread = start_thread(std::move(body));
  if (thread) thread->detach();
  return thread.has_value();
}

std::unique_ptr<LineWriter> LineWriter::open(const std::string& path) {
  // O_NONBLOCK makes open() refuse a pipe without a reader instead of waiting for one.
  const bool cut = ends_within_a_line(path);
  constexpr int flags = O_WRONLY | O_APPEND | O_CREAT | O_NONBLOCK | O_CLOEXEC;
  FileDescriptor file{::open(path.c_str(), flags, 0666)};
  if (!file) return nullptr;
  auto writer = std::make_unique<LineWriter>(std::move(file));
  writer->state_->cut = cut;
  return writer;
}

LineWriter::LineWriter(FileDescriptor file, StartThread start)
    : state_{std::make_shared<State>()}, start_{std::move(start)} {
  state_->file = std::move(file);
}

LineWriter::~LineWriter() {
  {
    const std::lock_guard lock{state_->mutex};
    state_->ends = true;
  }
  state_->changed.notify_all();
}

/// Starts the thread with the first line and not in the constructor, so that the thread inherits
/// the signal mask that the caller has at that time.
void LineWriter::ensure_thread() {
  if (has_thread_) return;
  const Time now = monotonic_now();
  if (now < next_try_) return;
  next_try_ = now + try_again;
  has_thread_ = start_([state = state_] { state->run(); });
}

void LineWriter::add(std::string_view line) {
  {
    const std::lock_guard lock{state_->mutex};
    if (state_->waiting.size() + line.size() >= most_waiting) {
      ++state_->lost;
    } else {
      state_->waiting.append(line).push_back('\n');
    }
  }
  state_->changed.notify_all();
  ensure_thread();
}

std::uint64_t LineWriter::take_lost() {
  const std::lock_guard lock{state_->mutex};
  return std::exchange(state_->lost, 0);
}

bool LineWriter::flush(Time limit) {
  std::unique_lock lock{state_->mutex};
  const auto through = [this] { return state_->waiting.empty() && !state_->writing; };
  if (!has_thread_ && !through()) {
    lock.unlock();
    next_try_ = {};
    ensure_thread();
    lock.lock();
  }
  if (has_thread_) return state_->changed.wait_for(lock, limit, through);
  lock.unlock();
  return write_through(limit);
}

bool LineWriter::write_through(Time limit) {
  if (has_thread_) return true;
  const std::lock_guard lock{state_->mutex};  // never contended, because there is no thread
  std::string& waiting = state_->waiting;
  if (waiting.empty()) return true;
  if (std::exchange(state_->cut, false)) waiting.insert(0, 1, '\n');
  std::size_t done = 0;
  const Takes takes = write_until(state_->file.get(), waiting, monotonic_now() + limit, done);
  waiting.erase(0, done);
  if (takes == Takes::nothing_ever) {
    state_->lost += lines_in(std::exchange(waiting, {}));
  }
  return waiting.empty();
}

}  // namespace takt
