#pragma once
#include <chrono>
#include <expected>
#include <optional>
#include <string>
#include <string_view>
#include <sys/stat.h>
#include <takt/lcm.hpp>
#include <utility>
#include <vector>

#include "eds_parser/values/time.hpp"

namespace takt {

/// Parses the text of a key file: each line holds a name and 64 hex digits, and `#` begins a
/// comment. The error is a sentence with `where` and the line number.
std::expected<std::vector<EnvelopeKey>, std::string> parse_keys(const std::string& where,
                                                                std::string_view text);

/// Creates a file with one new random key, mode 0600. Fails if the file already exists, and leaves
/// it unchanged.
std::expected<void, std::string> make_key_file(const std::string& path, const std::string& name);

/// Time between two checks whether a key file has changed.
inline constexpr Time look_pause = std::chrono::seconds{1};

/// A key file that may change while it is in use.
class WatchedKeyFile {
 public:
  /// Opens the file and reads it for the first time.
  static std::expected<WatchedKeyFile, std::string> open(std::string path);

  const std::vector<EnvelopeKey>& keys() const noexcept { return keys_; }
  const std::string& path() const noexcept { return path_; }
  /// Returns std::nullopt if the file is unchanged. Otherwise states whether the file could be read
  /// again; after an error, the previous keys stay in use. If descriptors or memory are missing,
  /// each further call tries again, and the error is returned only once.
  std::optional<std::expected<void, std::string>> reread();

 private:
  explicit WatchedKeyFile(std::string path) : path_{std::move(path)} {}

  std::string path_;
  std::vector<EnvelopeKey> keys_;
  struct stat seen_{};
  bool retries_ = false;  ///< the reading has failed for a temporary reason, and is tried again
};

}  // namespace takt
