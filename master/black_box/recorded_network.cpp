#include "master/black_box/recorded_network.hpp"

#include <filesystem>

#include "master/black_box/recording_file.hpp"
#include "master/black_box/recording_format.hpp"

namespace takt {

namespace fs = std::filesystem;

std::string log_of_recording(const std::string& file) {
  const std::string stem = recording_stem(file);
  return stem == file ? file : stem + recording_format::log_ending;
}

std::string events_file_of(const std::string& log) {
  return recording_stem(log) + recording_format::events_ending;
}

std::string network_of_recording(const std::string& log) {
  std::error_code error;
  if (!fs::exists(events_file_of(log), error)) return {};
  const auto recording = read_recording(log);
  if (!recording) return {};
  const fs::path named = recording->head.network;
  const fs::path beside = fs::path{log}.parent_path() / named.filename();
  for (const fs::path& path : {named, beside}) {
    if (fs::is_regular_file(path, error)) return path.string();
  }
  return {};
}

}  // namespace takt
