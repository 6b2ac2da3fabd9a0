#include <cerrno>
#include <cstring>
#include <exception>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "master/black_box/recording_format.hpp"
#include "master/trace/candump_line.hpp"

namespace takt {
namespace {

constexpr std::uintmax_t most_bytes = 1U << 30;  // size limit of one file
constexpr std::size_t most_parts = 1000;

template <class T>
using Result = std::expected<T, std::string>;

Result<std::ifstream> open(const std::string& path) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  std::ifstream file{path, std::ios::binary};
  if (error || !file) {
    const int why = error ? error.value() : errno;
    return std::unexpected{path + ": cannot be read: " + std::strerror(why)};
  }
  if (size > most_bytes) {
    return std::unexpected{
        fmt::format("{}: a file of {} MiB is not a recording of takt", path, size >> 20)};
  }
  return file;
}

Result<std::vector<std::uint64_t>> read_journal(const std::string& path) {
  auto file = open(path);
  if (!file) return std::unexpected{file.error()};
  const std::string bytes{std::istreambuf_iterator<char>{*file}, {}};
  const std::size_t begin = recording_format::magic.size();
  if (!bytes.starts_with(recording_format::magic)) {
    return std::unexpected{path + ": not a journal of takt, or a journal of another version"};
  }
  if ((bytes.size() - begin) % sizeof(std::uint64_t) != 0) {
    return std::unexpected{path + ": cut off: the length is not a multiple of 8 bytes"};
  }
  std::vector<std::uint64_t> words((bytes.size() - begin) / sizeof(std::uint64_t));
  if (!words.empty()) std::memcpy(words.data(), bytes.data() + begin, bytes.size() - begin);
  return words;
}

Result<std::vector<Frame>> read_log(const std::string& path) {
  auto file = open(path);
  if (!file) return std::unexpected{file.error()};
  std::vector<Frame> frames;
  std::string text;
  for (std::size_t number = 1; std::getline(*file, text); ++number) {
    const auto line = parse_candump(text);
    if (!line || line->error_frame) {
      return std::unexpected{fmt::format("{}:{}: not a line of `candump -L`", path, number)};
    }
    frames.push_back(line->frame);
  }
  return frames;
}

template <class T>
void read(const nlohmann::json& json, T& out, const auto& fields) {
  const auto read_one = [&](const auto& field) { json.at(field.first).get_to(out.*field.second); };
  std::apply([&](const auto&... field) { (read_one(field), ...); }, fields);
}

void read_events(std::istream& in, LoadedRecording& loaded, std::size_t& frames) {
  const nlohmann::json json = nlohmann::json::parse(in);
  const int version = json.at("format").get<int>();
  if (version < 1 || version > recording_format::version) {
    throw std::runtime_error{fmt::format("the format is {}; this takt reads 1 to {}", version,
                                         recording_format::version)};
  }
  read(json, loaded.head, recording_format::head_fields);
  frames = json.at("frames").get<std::size_t>();
  for (const nlohmann::json& event : json.at("events")) {
    read(event, loaded.decisions.emplace_back(), recording_format::decision_fields);
  }
}

/// Reads one recording, without the recordings that it follows.
Result<LoadedRecording> read_part(const std::string& stem) {
  LoadedRecording loaded;
  const std::string log = stem + recording_format::log_ending;
  const std::string events = stem + recording_format::events_ending;
  auto in = open(events);
  if (!in) return std::unexpected{in.error()};
  std::size_t count = 0;
  try {
    read_events(*in, loaded, count);
  } catch (const std::exception& error) {
    return std::unexpected{events + ": not the events of a recording: " + error.what()};
  }
  auto words = read_journal(stem + recording_format::journal_ending);
  if (!words) return std::unexpected{words.error()};
  auto frames = read_log(log);
  if (!frames) return std::unexpected{frames.error()};
  if (frames->size() != count) {
    return std::unexpected{fmt::format(
        "{}: {} frames, but {} were recorded: change frames, but do not add or remove any", log,
        frames->size(), count)};
  }
  loaded.parts.push_back({.words = std::move(*words), .frames = std::move(*frames)});
  loaded.logs.push_back(log);
  return loaded;
}

bool is_from_start(const Recording& recording) {
  return !recording.words.empty() && journal::mark_of(recording.words.front()) == Mark::now;
}

void put_before(LoadedRecording& earlier, LoadedRecording& loaded) {
  const auto join = [](auto& first, auto& second) {
    first.insert(first.end(), std::make_move_iterator(second.begin()),
                 std::make_move_iterator(second.end()));
    second = std::move(first);
  };
  join(earlier.parts, loaded.parts);
  join(earlier.logs, loaded.logs);
  join(earlier.decisions, loaded.decisions);
}

/// Reads the earlier recordings, back to the start of the master as far as the files reach.
void read_earlier(const std::filesystem::path& folder, LoadedRecording& loaded) {
  std::string follows = loaded.head.follows;
  while (!is_from_start(loaded.parts.front())) {
    if (follows.empty()) {
      loaded.fault = "the recording begins in the middle of the run";
      return;
    }
    const auto name = std::filesystem::path{follows}.filename().string();
    auto earlier = loaded.parts.size() < most_parts
                       ? read_part((folder / name).string())
                       : std::unexpected{fmt::format("more than {} recordings", most_parts)};
    if (!earlier || name.empty()) {
      loaded.fault = "the recording follows " + name +
                     ", which can't be used: " + (earlier ? "no name" : earlier.error());
      return;
    }
    follows = earlier->head.follows;
    put_before(*earlier, loaded);
  }
}

}  // namespace

std::string recording_stem(const std::string& file) {
  using namespace recording_format;
  for (const std::string_view ending : {events_ending, log_ending, journal_ending}) {
    if (file.ends_with(ending)) return file.substr(0, file.size() - ending.size());
  }
  return file;
}

std::expected<LoadedRecording, std::string> read_recording(const std::filesystem::path& file) {
  const std::filesystem::path stem{recording_stem(file.string())};
  auto loaded = read_part(stem.string());
  if (!loaded) return loaded;
  read_earlier(stem.parent_path(), *loaded);
  if (!loaded->fault) return loaded;
  if (begin_with_checkpoint(*loaded)) {
    loaded->fault.reset();
  } else {
    *loaded->fault += "; and the recording has no checkpoint at which a replay could begin";
  }
  return loaded;
}

}  // namespace takt
