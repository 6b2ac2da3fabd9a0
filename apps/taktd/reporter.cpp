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
  say(notice.weight, notice.text);
  if (events_.is_open()) write(notice);
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
