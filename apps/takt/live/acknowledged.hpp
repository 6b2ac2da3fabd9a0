#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace takt {

/// The EMCYs that the user has acknowledged, for each node of each bus. They are kept in a file of
/// the user. The daemon does not know them; they affect only what the programs show.
class Acknowledged {
 public:
  /// Returns the file: `takt/acknowledged` in XDG_STATE_HOME, or in ~/.local/state. Empty if
  /// neither XDG_STATE_HOME nor HOME is set.
  static std::optional<std::filesystem::path> file();
  /// Reads the file. If the file does not exist, nothing is acknowledged. Lines that cannot be read
  /// are left out. Throws a Failure if the file exists and cannot be read.
  static Acknowledged load(const std::filesystem::path& path);
  /// Reads the text of such a file: one line with time, node-ID and bus for each node.
  static Acknowledged of(std::string_view text);

  /// Returns true if the EMCY of this time, in microseconds since 1970, is acknowledged.
  bool contains(const std::string& bus, int node, std::int64_t utime) const;
  /// Acknowledges the EMCYs of a node up to this time.
  void add(const std::string& bus, int node, std::int64_t utime);

  std::string text() const;
  /// Writes the file, and makes its folder. Throws a Failure if that is not possible.
  void save(const std::filesystem::path& path) const;

 private:
  using Node = std::pair<std::string, int>;

  static constexpr std::size_t most_nodes = 4096;

  std::map<Node, std::int64_t> until_;
};

}  // namespace takt
