#include "apps/takt/log/log_file.hpp"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

namespace takt::logging {
namespace {

constexpr ::mode_t readable_by_all = 0666;  // less the umask

std::string because(const std::string& path, int error) {
  return fmt::format("{}: can't be written: {}", path, std::strerror(error));
}

/// Returns true if the file system can't reserve room. There may be room all the same.
bool is_unsupported(int error) noexcept {
  return error == EOPNOTSUPP || error == ENOSYS || error == ENODEV || error == ESPIPE;
}

}  // namespace

std::expected<std::unique_ptr<LogFile>, std::string> LogFile::create(const std::string& path) {
  std::signal(SIGXFSZ, SIG_IGN);  // a write beyond the file size limit fails instead
  namespace fs = std::filesystem;
  std::error_code none;
  const auto made = [&](std::string part, int fd) {
    return std::unique_ptr<LogFile>{new LogFile{path, std::move(part), FileDescriptor{fd}}};
  };
  if (path == "-") return made({}, ::dup(STDOUT_FILENO));
  if (fs::is_directory(path, none)) return std::unexpected{path + ": is a directory"};
  const bool is_device = fs::exists(path, none) && !fs::is_regular_file(path, none);
  const fs::path wanted{path};
  const std::string part =
      is_device ? std::string{}
                : (wanted.parent_path() / (".part-" + wanted.filename().string())).string();
  const int flags = O_WRONLY | O_CLOEXEC | (is_device ? 0 : O_CREAT | O_TRUNC);
  const int fd = ::open(is_device ? path.c_str() : part.c_str(), flags, readable_by_all);
  if (fd < 0) return std::unexpected{because(path, errno)};
  return made(part, fd);
}

LogFile::~LogFile() {
  if (!part_.empty()) ::unlink(part_.c_str());
}

bool LogFile::fail(int error) {
  if (trouble_.empty()) trouble_ = std::strerror(error);
  return false;
}

bool LogFile::reserve(std::uint64_t bytes) {
  if (part_.empty()) return true;
  rlimit most{};
  if (::getrlimit(RLIMIT_FSIZE, &most) == 0 && most.rlim_cur != RLIM_INFINITY &&
      size_ + bytes > most.rlim_cur) {
    return fail(EFBIG);
  }
  int done = 0;
  do {
    done = ::fallocate(file_.get(), FALLOC_FL_KEEP_SIZE, static_cast<::off_t>(size_),
                       static_cast<::off_t>(bytes));
  } while (done != 0 && errno == EINTR);
  return done == 0 || is_unsupported(errno) || fail(errno);
}

bool LogFile::write(std::string_view bytes) {
  std::string_view rest = bytes;
  while (!rest.empty()) {
    const ::ssize_t written = ::write(file_.get(), rest.data(), rest.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      fail(written < 0 ? errno : ENOSPC);
      const auto before = static_cast<::off_t>(size_);
      if (!part_.empty() && ::ftruncate(file_.get(), before) == 0) {
        ::lseek(file_.get(), before, SEEK_SET);
      }
      return false;
    }
    rest.remove_prefix(static_cast<std::size_t>(written));
  }
  size_ += bytes.size();
  return true;
}

std::expected<void, std::string> LogFile::commit() {
  if (part_.empty()) return {};
  const bool good = ::ftruncate(file_.get(), static_cast<::off_t>(size_)) == 0 &&
                    (::fsync(file_.get()) == 0 || errno == EINVAL) &&
                    ::rename(part_.c_str(), path_.c_str()) == 0;
  if (!good) return std::unexpected{because(path_, errno)};
  part_.clear();
  return {};
}

}  // namespace takt::logging
