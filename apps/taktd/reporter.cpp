#include "apps/taktd/reporter.hpp"

#include <nlohmann/json.hpp>
#include <utility>

#include "master/linux/clock.hpp"

namespace takt {

bool Reporter::open_events(const std::string& path) {
  events_ = LineWriter::open(path);
  return events_ != nullptr;
}

void Reporter::say(Weight weight, const std::string& sentence) {
  settle();
  log_.say(weight, sentence);
}

void Reporter::say(const Notice& notice) {
  ++reported_[static_cast<std::size_t>(notice.weight)];
  log_.say(notice.weight, notice.text);
}

void Reporter::settle() {
  if (const auto notice = merged_.take()) say(*notice);
}

void Reporter::announce(const BusPlan& plan, const Notice& notice) {
  if (const auto before = merged_.add(notice)) say(*before);
  if (!events_) return;
  report_lost();
  write(notice, node_name(plan, notice.node));
  if (events_->has_thread() || std::exchange(without_thread_reported_, true)) return;
  say(Weight::warning,
      "--events: no thread can be created for this file; its lines wait, and taktd tries again");
}

/// Reports lost lines on stderr and in the file, at the place of the gap.
void Reporter::report_lost() {
  const std::uint64_t lost = events_->take_lost();
  if (lost == 0) return;
  const Notice gap{
      .when = monotonic_now(),
      .kind = "events_lost",
      .weight = Weight::warning,
      .text = "--events: " + std::to_string(lost) + " lines could not be written and are lost"};
  settle();
  say(gap);
  write(gap, {});
}

void Reporter::finish(Time limit) {
  settle();
  if (events_) {
    const bool through = events_->flush(limit);
    if (!through)
      say(Weight::warning, "--events: the file takes no more lines; the last lines are lost");
    report_lost();
  }
  log_.flush(limit);
}

void Reporter::write(const Notice& notice, std::string_view node) {
  using std::chrono::microseconds;
  const Time wall = notice.when + realtime_offset();
  const nlohmann::json line{{"utime", std::chrono::duration_cast<microseconds>(wall).count()},
                            {"cycle", notice.cycle},
                            {"node", notice.node},
                            {"name", std::string{node}},
                            {"kind", notice.kind},
                            {"severity", std::string{name(notice.weight)}},
                            {"text", notice.text}};
  events_->add(line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

}  // namespace takt
