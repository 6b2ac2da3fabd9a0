#include "apps/taktd/reporter.hpp"

#include <nlohmann/json.hpp>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include "master/linux/clock.hpp"

namespace takt {
namespace {

spdlog::level::level_enum level_of(Weight weight) noexcept {
  switch (weight) {
    case Weight::note:
      return spdlog::level::info;
    case Weight::warning:
      return spdlog::level::warn;
    case Weight::error:
      return spdlog::level::err;
  }
  return spdlog::level::err;
}

}  // namespace

void start_log() {
  spdlog::set_default_logger(spdlog::stderr_color_mt("taktd"));
  spdlog::set_pattern("%H:%M:%S.%e %^%=7l%$ %v");
}

bool Reporter::open_events(const std::string& path) {
  events_.open(path, std::ios::app);
  return events_.good();
}

void Reporter::say(Weight weight, const std::string& sentence) {
  spdlog::log(level_of(weight), "{}", sentence);
}

void Reporter::tell(const Notice& notice) {
  ++told_[static_cast<std::size_t>(notice.weight)];
  show(notice);
  if (events_.is_open()) write(notice);
}

void Reporter::show(const Notice& notice) {
  constexpr int most_a_second = 6;
  Shown& shown = shown_[{notice.kind, notice.node}];
  if (notice.when - shown.second >= std::chrono::seconds{1}) {
    shown.second = notice.when;
    shown.count = 0;
  }
  if (++shown.count > most_a_second) {
    ++shown.kept_back;
    return;
  }
  const std::uint64_t kept_back = std::exchange(shown.kept_back, 0);
  say(notice.weight, kept_back == 0 ? notice.text
                                    : notice.text + " (" + std::to_string(kept_back) +
                                          " more of this kind before)");
}

void Reporter::write(const Notice& notice) {
  using std::chrono::microseconds;
  const Time wall = notice.when + realtime_offset();
  const nlohmann::json line{{"utime", std::chrono::duration_cast<microseconds>(wall).count()},
                            {"cycle", notice.cycle},
                            {"node", notice.node},
                            {"name", std::string{node_name(plan_, notice.node)}},
                            {"kind", notice.kind},
                            {"severity", std::string{name(notice.weight)}},
                            {"text", notice.text}};
  events_ << line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) << '\n'
          << std::flush;
}

}  // namespace takt
