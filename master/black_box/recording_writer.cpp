#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <fstream>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "master/black_box/decode_tape.hpp"
#include "master/black_box/recording_format.hpp"
#include "master/explain/boot_report.hpp"
#include "master/linux/file_descriptor.hpp"

namespace takt {
namespace {

std::string log_text(const Frame& frame) {
  const int digits = frame.id.is_extended() ? 8 : 3;
  const std::string id = fmt::format("{:0{}X}#", frame.id.id(), digits);
  if (frame.rtr) return id + (frame.length == 0 ? "R" : fmt::format("R{}", frame.length));
  return fmt::format("{}{:02X}", id, fmt::join(frame.payload(), ""));
}

void write_log(std::ostream& out, const DecodedTape& tape, const std::string& interface) {
  for (const LoggedFrame& logged : tape.frames) {
    const std::int64_t us = (logged.when + tape.since_1970).count() / 1000;
    out << fmt::format("({:010}.{:06}) {} {}\n", us / 1'000'000, us % 1'000'000, interface,
                       log_text(logged.frame));
  }
}

void write_journal(std::ostream& out, const std::vector<std::uint64_t>& words) {
  out.write(recording_format::magic.data(), recording_format::magic.size());
  out.write(reinterpret_cast<const char*>(words.data()),
            static_cast<std::streamsize>(words.size() * sizeof(std::uint64_t)));
}

template <class T>
void write(nlohmann::ordered_json& json, const T& in, const auto& fields) {
  const auto write_one = [&](const auto& field) { json[field.first] = in.*field.second; };
  std::apply([&](const auto&... field) { (write_one(field), ...); }, fields);
}

void write_events(std::ostream& out, const BusPlan& plan, const RecordingHead& head,
                  const DecodedTape& tape) {
  nlohmann::ordered_json json{{"format", recording_format::version}};
  write(json, head, recording_format::head_fields);
  json["frames"] = tape.frames.size();
  json["events"] = nlohmann::ordered_json::array();
  for (const Event& event : tape.events) {
    auto& object = json["events"].emplace_back();
    object["utime"] = (event.when + tape.since_1970).count() / 1000;
    write(object, to_decision(plan, event), recording_format::decision_fields);
  }
  out << json.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
}

/// Returns the name of the interface without blanks, because candump separates columns by blanks.
std::string interface_of(const BusPlan& plan) {
  std::string text = plan.interface.empty() ? plan.name : plan.interface;
  std::ranges::replace_if(text, [](char letter) { return letter <= ' ' || letter == '#'; }, '_');
  return text.empty() ? "bus" : text;
}

/// Returns true if the file has reached the disk. Some disks accept data at first and refuse it
/// later (quotas, network).
bool reaches_the_disk(const std::string& path) noexcept {
  const FileDescriptor file{::open(path.c_str(), O_WRONLY | O_CLOEXEC)};
  return file && (::fsync(file.get()) == 0 || errno == EINVAL || errno == EROFS);
}

/// Files of one recording. They have other names until all of them are complete.
class UnfinishedFiles {
 public:
  explicit UnfinishedFiles(const std::filesystem::path& stem)
      : stem_{stem.string()},
        unfinished_{(stem.parent_path() /
                     (std::string{recording_format::incomplete} + stem.filename().string()))
                        .string()} {}
  ~UnfinishedFiles() {
    std::error_code ignored;
    for (const std::string& path : made_) std::filesystem::remove(path, ignored);
  }
  UnfinishedFiles(const UnfinishedFiles&) = delete;
  UnfinishedFiles& operator=(const UnfinishedFiles&) = delete;

  template <class F>
  void write(const char* ending, F&& write) {
    if (error_) return;
    const std::string path = unfinished_ + ending;
    made_.push_back(path);
    endings_.push_back(ending);
    errno = 0;
    std::ofstream file{path, std::ios::binary | std::ios::trunc};
    if (file) write(file);
    file.close();
    if (!file || !reaches_the_disk(path)) refuse(ending, errno);
  }
  /// Gives all files their final names.
  std::expected<void, std::string> finish() {
    std::error_code error;
    for (std::size_t i = 0; i < endings_.size() && !error_; ++i) {
      std::filesystem::rename(made_[i], stem_ + endings_[i], error);
      if (error) refuse(endings_[i], error.value());
      if (!error) made_[i] = stem_ + endings_[i];
    }
    if (error_) return std::unexpected{*error_};
    made_.clear();
    return {};
  }

 private:
  void refuse(const char* ending, int error) {
    error_ = stem_ + ending + ": can't be written: " + std::strerror(error);
  }

  std::string stem_;
  std::string unfinished_;
  std::vector<std::string> made_;  // files to remove if the recording is not finished
  std::vector<const char*> endings_;
  std::optional<std::string> error_;
};

}  // namespace

Decision to_decision(const BusPlan& plan, const Event& event) {
  return {.time = event.when.count(),
          .cycle = event.cycle,
          .node = event.node,
          .kind = std::string{name(event.kind)},
          .value = event.value,
          .detail = event.detail,
          .bytes = fmt::format("{:02X}", fmt::join(event.bytes, "")),
          .text = describe(plan, event)};
}

std::expected<void, std::string> write_recording(const std::filesystem::path& stem,
                                                 const BusPlan& plan, const RecordingHead& head,
                                                 const std::vector<std::uint64_t>& records) {
  const DecodedTape tape = decode_tape(records);
  RecordingHead reported = head;
  reported.from_start = !records.empty() && journal::mark_of(records.front()) == Mark::now;
  UnfinishedFiles files{stem};
  files.write(recording_format::journal_ending,
              [&](std::ostream& out) { write_journal(out, tape.words); });
  files.write(recording_format::events_ending,
              [&](std::ostream& out) { write_events(out, plan, reported, tape); });
  files.write(recording_format::log_ending,
              [&](std::ostream& out) { write_log(out, tape, interface_of(plan)); });
  return files.finish();
}

}  // namespace takt
