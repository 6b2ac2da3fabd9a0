#include "apps/taktd/process/error_log.hpp"

#include <algorithm>
#include <spdlog/details/null_mutex.h>
#include <spdlog/logger.h>
#include <spdlog/sinks/base_sink.h>
#include <string_view>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

#include "apps/taktd/process/environment.hpp"
#include "apps/taktd/process/open_again.hpp"
#include "eds_parser/values/number_in.hpp"

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

/// Returns true if the file is the one that JOURNAL_STREAM names as device:inode. A program that
/// systemd has started may write elsewhere. systemd.exec(5).
bool is_journal(int file) {
  const std::string_view stream = environment("JOURNAL_STREAM");
  const std::size_t colon = std::min(stream.find(':'), stream.size());
  const auto device = number_in<std::uint64_t>(stream.substr(0, colon));
  const auto inode = number_in<std::uint64_t>(stream.substr(std::min(colon + 1, stream.size())));
  struct stat status{};
  return device && inode && ::fstat(file, &status) == 0 && status.st_dev == *device &&
         status.st_ino == *inode;
}

/// Puts the priority of syslog(3) before each line of a text.
std::string with_priority(std::string_view text, spdlog::level::level_enum level) {
  const std::string_view priority = level >= spdlog::level::err    ? "<3>"
                                    : level == spdlog::level::warn ? "<4>"
                                                                   : "<6>";
  std::string lines{priority};
  for (const char c : text) {
    lines += c;
    if (c == '\n') lines += priority;
  }
  return lines;
}

}  // namespace

/// An spdlog sink that passes each line to a LineWriter.
class ErrorLog::Sink final : public spdlog::sinks::base_sink<spdlog::details::null_mutex> {
 public:
  Sink(LineWriter& writer, Form form) : writer_{writer}, form_{form} {}

 private:
  void sink_it_(const spdlog::details::log_msg& message) override {
    spdlog::memory_buf_t buffer;
    formatter_->format(message, buffer);
    std::string line{buffer.data(), buffer.size()};
    while (line.ends_with('\n')) line.pop_back();
    if (form_ == Form::coloured && message.color_range_end > message.color_range_start) {
      line.insert(message.color_range_end, "\033[m");
      line.insert(message.color_range_start, colour_of(message.level));
    }
    writer_.add(form_ == Form::journal ? with_priority(line, message.level) : line);
  }
  void flush_() override {}

  LineWriter& writer_;
  Form form_;
};

FileDescriptor ErrorLog::stderr_again() { return open_again(STDERR_FILENO); }

ErrorLog::ErrorLog(FileDescriptor file, LineWriter::StartThread start)
    : ErrorLog{form_of(file.get()), std::move(file), std::move(start)} {}

ErrorLog::Form ErrorLog::form_of(int file) {
  if (is_journal(file)) return Form::journal;
  const bool colours =
      ::isatty(file) != 0 && environment("NO_COLOR").empty() && environment("TERM") != "dumb";
  return colours ? Form::coloured : Form::plain;
}

ErrorLog::ErrorLog(Form form, FileDescriptor file, LineWriter::StartThread start)
    : writer_{std::move(file), std::move(start)} {
  log_ = std::make_unique<spdlog::logger>("taktd", std::make_shared<Sink>(writer_, form));
  log_->set_pattern(form == Form::journal ? "%v" : "%H:%M:%S.%e %^%=7l%$ %v");
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
