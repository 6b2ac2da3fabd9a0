#include "apps/takt/live/acknowledged.hpp"

#include <algorithm>
#include <cstdlib>
#include <fmt/format.h>
#include <istream>
#include <sstream>
#include <system_error>

#include "apps/command_line/failure.hpp"
#include "apps/command_line/text_file.hpp"
#include "master/lcm/printable_text.hpp"

namespace takt {

std::optional<std::filesystem::path> Acknowledged::file() {
  const char* const state = std::getenv("XDG_STATE_HOME");
  const char* const home = std::getenv("HOME");
  // A relative path is invalid: XDG Base Directory Specification.
  if (state != nullptr && std::filesystem::path{state}.is_absolute()) {
    return std::filesystem::path{state} / "takt/acknowledged";
  }
  if (home == nullptr || *home == '\0') return std::nullopt;
  return std::filesystem::path{home} / ".local/state/takt/acknowledged";
}

Acknowledged Acknowledged::load(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) return {};
  return of(value_or_fail(read_whole_file(path), exit_wrong_use));
}

Acknowledged Acknowledged::of(std::string_view text) {
  Acknowledged acknowledged;
  std::istringstream lines{std::string{text}};
  for (std::string line; std::getline(lines, line);) {
    std::istringstream fields{line};
    std::int64_t utime = 0;
    int node = 0;
    std::string bus;
    if (fields >> utime >> node && std::getline(fields >> std::ws, bus) && !bus.empty()) {
      acknowledged.add(bus, node, utime);
    }
  }
  return acknowledged;
}

bool Acknowledged::contains(const std::string& bus, int node, std::int64_t utime) const {
  const auto found = until_.find({printable_text(bus), node});
  return found != until_.end() && utime <= found->second;
}

/// Removes the node with the oldest time if there are more than `most_nodes` nodes.
void Acknowledged::add(const std::string& bus, int node, std::int64_t utime) {
  std::int64_t& until = until_[{printable_text(bus), node}];
  until = std::max(until, utime);
  if (until_.size() <= most_nodes) return;
  until_.erase(
      std::ranges::min_element(until_, {}, [](const auto& entry) { return entry.second; }));
}

std::string Acknowledged::text() const {
  std::string text;
  for (const auto& [node, utime] : until_) {
    text += fmt::format("{} {} {}\n", utime, node.second, node.first);
  }
  return text;
}

void Acknowledged::save(const std::filesystem::path& path) const {
  std::error_code error;
  std::filesystem::create_directories(path.parent_path(), error);
  if (error) {
    throw Failure{"can't make the folder " + path.parent_path().string() + ": " + error.message(),
                  exit_wrong_use};
  }
  value_or_fail(write_whole_file(path, text()), exit_wrong_use);
}

}  // namespace takt
