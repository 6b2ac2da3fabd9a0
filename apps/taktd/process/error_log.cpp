#include "apps/taktd/process/error_log.hpp"

#include <spdlog/details/null_mutex.h>
#include <spdlog/logger.h>
#include <spdlog/sinks/base_sink.h>
#include <unistd.h>
#include <utility>

#include "apps/taktd/process/open_again.hpp"

namespace takt {
namespace {

spdlog::level::level_enum level_of(Weight weight) noexcept {
  if (weight == Weight::note) return spdlog::level::info;
  return weight == Weight::warning ? spdlog::level::warn : spdlog::level::err;
}

const char* colour_of(spdlog::level::level_enum level) noexcept {
  if (level >= spdlog::level::err) return "\033[31m\033[1m";
  return level == spdlog::level::warn ? "\033[33m\033[1m" : "\033[32m";
}

}  // namespace

/// An spdlog sink that passes each line to a LineWriter.
class ErrorLog::Sink final : public spdlog::sinks::base_sink<spdlog::details::null_mutex> {
 public:
  Sink(LineWriter& writer, Colours colours) : writer_{writer}, colours_{colours} {}

 private:
  void sink_it_(const spdlog::details::log_msg& message) override {
    spdlog::memory_buf_t buffer;
    formatter_->format(message, buffer);
    std::string line{buffer.data(), buffer.size()};
    while (line.ends_with('\n')) line.pop_back();
    if (colours_ == Colours::ansi && message.color_range_end > message.color_range_start) {
      line.insert(message.color_range_end, "\033[m");
      line.insert(message.color_range_start, colour_of(message.level));
    }
    writer_.add(line);
  }
  void flush_() override {}

  LineWriter& writer_;
  Colours colours_;
};

FileDescriptor ErrorLog::stderr_again() { return open_again(STDERR_FILENO); }

ErrorLog::ErrorLog(FileDescriptor file, LineWriter::StartThread start)
    : ErrorLog{::isatty(file.get()) != 0 ? Colours::ansi : Colours::none, std::move(file),
               std::move(start)} {}

ErrorLog::ErrorLog(Colours colours, FileDescriptor file, LineWriter::StartThread start)
    : writer_{std::move(file), std::move(start)} {
  log_ = std::make_unique<spdlog::logger>("taktd", std::make_shared<Sink>(writer_, colours));
  log_->set_pattern("%H:%M:%S.%e %^%=7l%$ %v");
}

ErrorLog::~ErrorLog() = default;

void ErrorLog::say(Weight weight, const std::string& sentence) {
  if (const std::uint64_t lost = writer_.take_lost(); lost != 0) {
    log_->warn("stderr was not read fast enough: {} lines are lost here", lost);
  }
  log_->log(level_of(weight), "{}", sentence);
  if (writer_.has_thread()) return;
  if (!std::exchange(without_thread_reported_, true)) {
    log_->warn(
        "no thread can be created for stderr; taktd tries again. Until then taktd writes lines as "
        "fast as stderr takes them, and the other lines wait");
  }
  writer_.write_through(Time{0});
}

}  // namespace takt
