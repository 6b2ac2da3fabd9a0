#include "master/lcm/envelope/key_file.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sodium.h>
#include <unistd.h>
#include <utility>

#include "master/lcm/printable_text.hpp"
#include "master/linux/file_descriptor.hpp"
#include "master/linux/transient_error.hpp"

namespace takt {
namespace {

constexpr std::size_t most_bytes = 65536;
constexpr std::size_t most_keys = 64;
constexpr std::size_t longest_name = 32;

/// The reason why a file could not be read.
struct ReadFailure {
  std::string sentence;
  bool passing = false;  ///< another attempt may succeed although the file does not change
};

std::unexpected<ReadFailure> unreadable(const std::string& path, int error) {
  return std::unexpected{
      ReadFailure{"key file " + path + ": " + std::strerror(error), is_transient_error(error)}};
}

std::unexpected<std::string> failed(const std::string& path, const std::string& why) {
  return std::unexpected{"key file " + path + ": " + why};
}

std::unexpected<ReadFailure> unusable(const std::expected<void, std::string>& checked) {
  return std::unexpected{ReadFailure{checked.error()}};
}

bool is_name(std::string_view text) noexcept {
  const auto allowed = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_' ||
           c == '-' || c == '.';
  };
  return !text.empty() && text.size() <= longest_name && std::ranges::all_of(text, allowed);
}

std::string_view take_word(std::string_view& line) noexcept {
  constexpr std::string_view blanks = " \t\r";
  line.remove_prefix(std::min(line.find_first_not_of(blanks), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(blanks));
  line.remove_prefix(word.size());
  return word;
}

bool read_secret(std::string_view hex, EnvelopeKey& key) noexcept {
  return hex.size() == 2 * EnvelopeKey::bytes &&
         ::sodium_hex2bin(key.secret.data(), key.secret.size(), hex.data(), hex.size(), nullptr,
                          nullptr, nullptr) == 0;
}

/// Checks the owner, the mode and the size. The error says how to correct the file.
std::expected<void, std::string> check_permissions(const std::string& path,
                                                   const struct stat& status) {
  if (!S_ISREG(status.st_mode)) return failed(path, "it is not a regular file");
  if (status.st_uid != ::geteuid() && status.st_uid != 0) {
    return failed(path, "it belongs to another user");
  }
  if ((status.st_mode & 077) != 0) {
    return failed(path, "users other than its owner can access it: chmod 600 " + path);
  }
  if (static_cast<std::size_t>(status.st_size) > most_bytes) {
    return failed(path, "the file is longer than 64 KiB");
  }
  return {};
}

std::expected<std::string, ReadFailure> read_all(int fd, const std::string& path) {
  std::string text;
  std::array<char, 4096> chunk;
  for (;;) {
    const ssize_t size = ::read(fd, chunk.data(), chunk.size());
    if (size < 0) return unreadable(path, errno);
    if (size == 0) return text;
    text.append(chunk.data(), static_cast<std::size_t>(size));
    if (text.size() > most_bytes) {
      return unusable(failed(path, "the file is longer than 64 KiB"));
    }
  }
}

/// Reads the whole text of a key file that has the right owner and mode.
std::expected<std::string, ReadFailure> read_key_file(const std::string& path) {
  const FileDescriptor file{::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK)};
  if (!file && errno == ELOOP) return unusable(failed(path, "it is not a regular file"));
  if (!file) return unreadable(path, errno);
  struct stat status{};
  if (::fstat(file.get(), &status) != 0) return unreadable(path, errno);
  if (auto good = check_permissions(path, status); !good) return unusable(good);
  return read_all(file.get(), path);
}

bool same_file(const struct stat& a, const struct stat& b) noexcept {
  return a.st_ino == b.st_ino && a.st_dev == b.st_dev && a.st_size == b.st_size &&
         a.st_mode == b.st_mode && a.st_ctim.tv_sec == b.st_ctim.tv_sec &&
         a.st_ctim.tv_nsec == b.st_ctim.tv_nsec;
}

}  // namespace

std::expected<std::vector<EnvelopeKey>, std::string> parse_keys(const std::string& where,
                                                                std::string_view text) {
  std::vector<EnvelopeKey> keys;
  for (int number = 1; !text.empty(); ++number) {
    std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    line = line.substr(0, line.find('#'));
    const std::string_view name = take_word(line);
    if (name.empty()) continue;
    const std::string here = "key file " + where + ":" + std::to_string(number) + ": ";
    if (!is_name(name)) {
      return std::unexpected{here +
                             "a name has 1 to 32 letters, digits, underscores, dashes or dots"};
    }
    EnvelopeKey key{.name = std::string{name}};
    if (!read_secret(take_word(line), key) || !take_word(line).empty()) {
      return std::unexpected{here + "expected a name and 64 hex digits"};
    }
    if (std::ranges::find(keys, key.name, &EnvelopeKey::name) != keys.end()) {
      return std::unexpected{here + "key '" + key.name + "' occurs twice"};
    }
    if (keys.size() == most_keys) return std::unexpected{here + "the file has more than 64 keys"};
    keys.push_back(std::move(key));
  }
  if (keys.empty()) return failed(where, "the file has no key");
  return keys;
}

std::expected<std::vector<EnvelopeKey>, std::string> load_keys(const std::string& path) {
  const auto text = read_key_file(path);
  if (!text) return std::unexpected{text.error().sentence};
  return parse_keys(path, *text);
}

std::expected<void, std::string> make_key_file(const std::string& path, const std::string& name) {
  if (!is_name(name)) {
    return failed(path, "'" + printable_text(name) +
                            "' is not a valid key name: a name has 1 to 32 letters, digits, "
                            "underscores, dashes or dots");
  }
  const FileDescriptor file{
      ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0600)};
  if (!file) return failed(path, std::strerror(errno));
  std::array<unsigned char, EnvelopeKey::bytes> secret;
  ::randombytes_buf(secret.data(), secret.size());
  std::array<char, 2 * EnvelopeKey::bytes + 1> hex;
  ::sodium_bin2hex(hex.data(), hex.size(), secret.data(), secret.size());
  const std::string line = name + ' ' + hex.data() + '\n';
  const ssize_t written = ::write(file.get(), line.data(), line.size());
  if (written == static_cast<ssize_t>(line.size()) && ::fsync(file.get()) == 0) return {};
  const std::string why = std::strerror(errno);
  ::unlink(path.c_str());
  return failed(path, why);
}

std::expected<WatchedKeyFile, std::string> WatchedKeyFile::open(std::string path) {
  WatchedKeyFile file{std::move(path)};
  if (const auto read = file.reread(); read && !*read) return std::unexpected{read->error()};
  return file;
}

std::optional<std::expected<void, std::string>> WatchedKeyFile::reread() {
  struct stat now{};
  if (::lstat(path_.c_str(), &now) != 0) now = {};
  const bool same = same_file(now, seen_);
  if (!keys_.empty() && same && !retries_) return std::nullopt;
  const bool reported = same && retries_;
  seen_ = now;
  const auto text = read_key_file(path_);
  retries_ = !text && text.error().passing;
  if (retries_ && reported) return std::nullopt;
  if (!text) return std::unexpected{text.error().sentence};
  auto keys = parse_keys(path_, *text);
  if (!keys) return std::unexpected{keys.error()};
  keys_ = std::move(*keys);
  return std::expected<void, std::string>{};
}

}  // namespace takt
