#include "master/black_box/black_box.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <exception>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <set>

#include "master/black_box/recording_format.hpp"
#include "master/linux/clock.hpp"
#include "master/linux/start_thread.hpp"
#include "master/linux/transient_error.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

constexpr Time time_after_fault = 1s;
constexpr Time distance = 10s;  // shortest time between two recordings
constexpr Time silence = 5min;  // shortest time between two recordings of one kind of fault

/// Returns the name of the bus without the characters that a file name can't contain.
std::string file_name(const std::string& bus) {
  std::string name = bus.substr(0, 64);
  std::ranges::replace_if(
      name, [](unsigned char c) { return std::isalnum(c) == 0 && c != '_'; }, '_');
  return name.empty() ? "bus" : name;
}

/// Returns the name of the bus with the local time, for example `lift-20260314T150926`.
std::string time_name(const std::string& bus) {
  return fmt::format("{}-{:%Y%m%dT%H%M%S}", bus, fmt::localtime(std::time(nullptr)));
}

bool is_recording_of(const std::string& name, const std::string& bus) {
  const std::size_t digits = bus.size() + 1;
  return name.starts_with(bus + '-') && name.size() > digits + 15 && name[digits + 8] == 'T' &&
         std::isdigit(static_cast<unsigned char>(name[digits])) != 0;
}

/// Removes the unfinished files of an earlier run that ended while it wrote a recording.
void forget_incomplete(const std::filesystem::path& folder, const std::string& bus) {
  std::set<std::filesystem::path> found;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator{folder, error}) {
    const std::string name = entry.path().filename().string();
    const std::string_view mark = recording_format::incomplete;
    if (name.starts_with(mark) && is_recording_of(name.substr(mark.size()), bus)) {
      found.insert(entry.path());
    }
  }
  for (const auto& path : found) std::filesystem::remove(path, error);
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

}  // namespace

std::expected<std::unique_ptr<BlackBox>, std::string> BlackBox::open(const BlackBoxOptions& options,
                                                                     const BusPlan& plan,
                                                                     RecordingHead head, Say say) {
  const auto refused = [&](const std::string& why) {
    return std::unexpected{"--black-box " + options.folder.string() + ": " + why};
  };
  std::error_code error;
  std::filesystem::create_directories(options.folder, error);
  if (error && !is_transient_error(error.value())) return refused(error.message());
  const auto probe = options.folder / ".takt";
  if (std::FILE* const file = std::fopen(probe.c_str(), "wb")) {
    std::fclose(file);
    std::filesystem::remove(probe, error);
  } else if (const int why = errno; !is_transient_error(why)) {
    return refused(std::error_code{why, std::generic_category()}.message());
  }
  forget_incomplete(options.folder, file_name(head.bus));
  return std::unique_ptr<BlackBox>{new BlackBox{options, plan, std::move(head), std::move(say)}};
}

BlackBox::BlackBox(const BlackBoxOptions& options, const BusPlan& plan, RecordingHead head, Say say)
    : options_{options},
      plan_{plan},
      head_{std::move(head)},
      say_{std::move(say)},
      journal_{options.bytes} {}

BlackBox::~BlackBox() {
  if (writer_.joinable()) writer_.join();
}

void BlackBox::on_fault(const std::string& kind, std::uint8_t node, const std::string& text,
                        Time now) {
  const auto [fault, first] = faults_.try_emplace({kind, node}, now);
  if (!first && now - fault->second < silence) return;
  fault->second = now;
  ask(first_line(text), now + time_after_fault);
}

void BlackBox::on_request(const std::string& reason, Time now) { ask(reason, now); }

/// Schedules a recording at `at`, but not before the minimum time since the previous recording is
/// over. A recording that is already scheduled is never delayed by a new request.
void BlackBox::ask(const std::string& reason, Time at) {
  if (last_ != Time{}) at = std::max(at, last_ + distance);
  if (reason_.empty()) reason_ = reason;
  due_ = std::min(due_, at);
}

void BlackBox::serve(Time now) {
  if (writer_.joinable() && !writing_.load(std::memory_order_acquire)) {
    end_writing();
    journal_.give_back();
  }
  if (writer_.joinable()) return;
  if (!wanted_ && now >= due_) {
    journal_.want();
    wanted_ = true;
    due_ = never;
    last_ = now;
  }
  if (!wanted_) return;
  const Tape* const tape = journal_.wanted();
  if (tape == nullptr) return;
  wanted_ = false;
  if (!write(*tape)) journal_.give_back();
}

bool BlackBox::finish(const std::string& reason, Time limit) {
  const Time until = monotonic_now() + limit;
  if (!end_writer(until)) return false;
  if (reason_.empty()) reason_ = reason;
  if (reason_.empty()) return true;
  const Tape* const tape = wanted_ ? journal_.wanted() : nullptr;
  return !write(tape != nullptr ? *tape : journal_.last()) || end_writer(until);
}

/// Waits until the writer, if there is one, has ended; checks every millisecond. Returns false
/// after the time `until`.
bool BlackBox::end_writer(Time until) {
  if (!writer_.joinable()) return true;
  while (writing_.load(std::memory_order_acquire)) {
    if (monotonic_now() > until) return false;
    std::this_thread::sleep_for(1ms);
  }
  end_writing();
  return true;
}

bool BlackBox::finish_running(const std::string& reason, Time limit) {
  const Time until = monotonic_now() + limit;
  const bool writes = writer_.joinable();
  if (!end_writer(until)) return false;
  if (writes) journal_.give_back();
  if (!wanted_) journal_.want();
  const Tape* tape = journal_.wanted();
  for (; tape == nullptr && monotonic_now() < until; tape = journal_.wanted()) {
    std::this_thread::sleep_for(1ms);
  }
  if (tape == nullptr) return false;  // the bus thread no longer begins a cycle
  if (reason_.empty()) reason_ = reason;
  return write(*tape) && end_writer(until) && !failed_;
}

/// Starts the writer. If no thread can be created, reports this and returns false; the tape is then
/// no longer needed.
bool BlackBox::write(const Tape& tape) {
  head_.reason = std::exchange(reason_, {});
  head_.follows = tape.whole() ? previous_ : "";
  writing_.store(true);
  auto writer = start_thread([this, &tape, head = head_] {
    write_files(tape, head);
    writing_.store(false, std::memory_order_release);
  });
  if (writer) {
    writer_ = std::move(*writer);
    return true;
  }
  writing_.store(false);
  previous_ = {};
  say_("black box: no recording is written (" + head_.reason +
           "), because no thread can be created: " + std::strerror(writer.error()),
       {});
  return false;
}

/// Runs in the writer's thread, which alone uses the folder.
void BlackBox::write_files(const Tape& tape, const RecordingHead& head) {
  std::filesystem::path stem = options_.folder;
  std::expected<void, std::string> result;
  try {
    stem = next_stem(file_name(head.bus));
    result = write_recording(stem, plan_, head, tape.read());
    if (result) forget_oldest(file_name(head.bus));
  } catch (const std::exception& error) {
    result = std::unexpected{stem.string() + ": " + error.what()};
  }
  failed_ = !result;
  previous_ = result ? stem.filename().string() : "";
  written_ = result ? stem.string() + recording_format::log_ending : result.error();
}

void BlackBox::end_writing() {
  writer_.join();
  if (failed_) return say_("black box: " + written_, {});
  say_("black box: " + written_ + " (" + head_.reason + "); takt replay " + written_, written_);
}

std::filesystem::path BlackBox::next_stem(const std::string& bus) const {
  const std::string name = time_name(bus);
  std::filesystem::path stem = options_.folder / name;
  std::error_code error;
  for (int again = 2; std::filesystem::exists(stem.string() + recording_format::log_ending, error);
       ++again) {
    stem = options_.folder / fmt::format("{}-{}", name, again);
  }
  return stem;
}

/// Removes the oldest recordings. This happens only after a new one is complete, so that a full
/// disk costs no recording.
void BlackBox::forget_oldest(const std::string& bus) const {
  std::set<std::string> stems;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator{options_.folder, error}) {
    const std::string name = entry.path().filename().string();
    if (is_recording_of(name, bus)) stems.insert(name.substr(0, name.find('.')));
  }
  while (stems.size() > options_.keep) {
    using namespace recording_format;
    for (const char* const ending : {log_ending, journal_ending, events_ending}) {
      std::filesystem::remove(options_.folder / (*stems.begin() + ending), error);
    }
    stems.erase(stems.begin());
  }
}

}  // namespace takt
