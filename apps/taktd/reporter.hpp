#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <string>

#include "apps/taktd/event_file.hpp"
#include "eds_parser/table/bus_plan.hpp"
#include "master/gateway/notice.hpp"

namespace takt {

/// Tells people: notices on stderr in words, and as JSON lines in a file. Front thread.
class Reporter {
 public:
  explicit Reporter(const BusPlan& plan) : plan_{plan} {}

  /// False: the file can't be written.
  bool open_events(const std::string& path);

  void tell(const Notice& notice);
  /// A sentence of the daemon itself.
  void say(Weight weight, const std::string& sentence);

  /// Once, at the end: waits for the file. False: it can't be written, and what is written to it
  /// keeps its thread; that is told.
  bool finish(Time limit);

  std::uint64_t told(Weight weight) const noexcept {
    return told_[static_cast<std::size_t>(weight)];
  }

 private:
  void write(const Notice& notice);
  void tell_lost();

  const BusPlan& plan_;
  std::unique_ptr<EventFile> events_;
  std::array<std::uint64_t, 3> told_{};
};

/// Sets up the way that lines on stderr look.
void start_log();

}  // namespace takt
