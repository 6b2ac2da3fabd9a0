#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "apps/taktd/process/error_log.hpp"
#include "apps/taktd/process/line_writer.hpp"
#include "eds_parser/table/bus_plan.hpp"
#include "master/gateway/notice/merged_notices.hpp"
#include "master/gateway/notice/notice.hpp"

namespace takt {

/// Writes notices as sentences to stderr and as JSON lines to a file. Notices of one cause share a
/// sentence; each has a line in the file. Used only by the front thread.
class Reporter {
 public:
  /// Returns false and sets errno if the file cannot be opened.
  bool open_events(const std::string& path);

  /// `plan` is the plan of the bus that the notice is about.
  void announce(const BusPlan& plan, const Notice& notice);
  /// Writes the sentence that was held back to be merged with further notices of the same cause.
  /// Call this after each round.
  void settle();
  /// Writes a sentence of the daemon itself to stderr.
  void say(Weight weight, const std::string& sentence);

  /// Waits for the file and for stderr, for at most `limit` each. Reports lost lines as far as
  /// possible.
  void finish(Time limit);

  /// Returns the number of sentences about notices.
  std::uint64_t reported(Weight weight) const noexcept {
    return reported_[static_cast<std::size_t>(weight)];
  }

 private:
  void write(const Notice& notice, std::string_view node);
  void say(const Notice& notice);
  void report_lost();

  ErrorLog log_;
  MergedNotices merged_;
  std::unique_ptr<LineWriter> events_;
  bool without_thread_reported_ = false;
  std::array<std::uint64_t, 3> reported_{};
};

}  // namespace takt
