#pragma once
#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <string_view>
#include <sys/stat.h>
#include <vector>

#include "master/gateway/envelope_key.hpp"

namespace takt {

/// The keys in the text of a key file: lines of a name and 64 hex digits, `#` begins a comment. An
/// error is a sentence with `where` and the line.
std::expected<std::vector<EnvelopeKey>, std::string> parse_keys(const std::string& where,
                                                                std::string_view text);

/// The keys in a file. It has to be a regular file that only its owner can read, and its owner is
/// this user or root. The error is a sentence.
std::expected<std::vector<EnvelopeKey>, std::string> load_keys(const std::string& path);

/// Makes a file with one new random key, mode 0600. A file that is there already is left alone.
std::expected<void, std::string> make_key_file(const std::string& path, const std::string& name);

/// A key file that may be changed while it is used.
class WatchedKeyFile {
 public:
  /// Reads the file for the first time.
  static std::expected<WatchedKeyFile, std::string> open(std::string path);

  const std::vector<EnvelopeKey>& keys() const noexcept { return keys_; }
  const std::string& path() const noexcept { return path_; }
  /// Nothing: the file is as it was. Else: it was read again, or can't be, and the keys from before
  /// are kept.
  std::optional<std::expected<void, std::string>> reread();

 private:
  explicit WatchedKeyFile(std::string path) : path_{std::move(path)} {}

  std::string path_;
  std::vector<EnvelopeKey> keys_;
  struct stat seen_{};
};

}  // namespace takt
