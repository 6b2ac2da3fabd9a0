#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <set>
#include <system_error>

#include "eds_parser/network_file/keys/read_devices.hpp"
#include "eds_parser/network_file/yaml/yaml_tree.hpp"

namespace takt {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_files = 1000;

bool is_folder(const fs::path& path) {
  std::error_code error;
  return fs::is_directory(path, error);
}

/// Returns the folders of the device data that come with takt. The program `bin/takt` finds
/// `share/takt/devices` beside the folder `bin`, in an installed takt and in the folder of a build.
/// Another program that contains the master may be in any folder, so it uses the device data of the
/// installed takt.
std::vector<fs::path> shipped() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  std::vector<fs::path> places;
  if (!error) places.push_back(program.parent_path().parent_path() / "share/takt/devices");
  places.emplace_back(TAKT_INSTALLED_DEVICES);
  return places;
}

std::vector<fs::path> files_of(const fs::path& folder, Findings& findings) {
  std::vector<fs::path> files;
  std::error_code error;
  fs::directory_iterator at{folder, error};
  for (; !error && at != fs::directory_iterator{}; at.increment(error)) {
    std::error_code ignored;  // A file that no longer exists is skipped.
    if (at->path().extension() != ".yaml" || !at->is_regular_file(ignored)) continue;
    files.push_back(at->path());
    if (files.size() > max_files) break;
  }
  if (error || files.size() > max_files) {
    findings.push_back(
        {folder.string(),
         {},
         Severity::error,
         "device-data",
         error ? "can't be read: " + error.message() : "more than 1000 files of device data"});
  }
  std::ranges::sort(files);
  return files;
}

}  // namespace

std::vector<fs::path> device_folders() {
  std::vector<fs::path> folders;
  const char* given = std::getenv("TAKT_DEVICES");
  std::string_view rest = given == nullptr ? "" : given;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(':'), rest.size());
    if (end > 0) folders.emplace_back(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  const std::vector<fs::path> places = shipped();
  const auto first = std::ranges::find_if(places, is_folder);
  if (first != places.end()) folders.push_back(*first);
  return folders;
}

std::vector<DeviceData> load_device_data(const std::vector<fs::path>& folders, Findings& findings) {
  std::vector<DeviceData> entries;
  std::set<std::string> known;
  for (const fs::path& folder : folders) {
    for (const fs::path& file : files_of(folder, findings)) {
      if (!known.insert(file.stem().string()).second) continue;
      auto entry = read_device_data(read_limited_file(file).value_or(""), file.string(), findings);
      if (entry) entries.push_back(std::move(*entry));
    }
  }
  return entries;
}

}  // namespace takt
