#pragma once
#include <array>
#include <cstdint>
#include <fstream>
#include <map>
#include <string>
#include <utility>

#include "eds_parser/table/bus_plan.hpp"
#include "master/gateway/notice.hpp"

namespace takt {

/// Tells people: events on stderr in words, a few a second of each kind and node; all of them as
/// JSON lines in a file. Front thread.
class Reporter {
 public:
  explicit Reporter(const BusPlan& plan) : plan_{plan} {}

  /// False: the file can't be written.
  bool open_events(const std::string& path);

  void tell(const Notice& notice);
  /// A sentence of the daemon itself.
  void say(Weight weight, const std::string& sentence);

  std::uint64_t told(Weight weight) const noexcept {
    return told_[static_cast<std::size_t>(weight)];
  }

 private:
  struct Shown {
    Time second{};  // that `count` counts in
    int count = 0;
    std::uint64_t kept_back = 0;
  };
  void show(const Notice& notice);
  void write(const Notice& notice);

  const BusPlan& plan_;
  std::map<std::pair<std::string, std::uint8_t>, Shown> shown_;
  std::ofstream events_;
  std::array<std::uint64_t, 3> told_{};
};

/// Sets up the way that lines on stderr look.
void start_log();

}  // namespace takt
