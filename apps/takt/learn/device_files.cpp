#include "apps/takt/learn/device_files.hpp"

#include <algorithm>
#include <charconv>
#include <ranges>
#include <system_error>

#include "eds_parser/dictionary/integer_of.hpp"
#include "eds_parser/read/eds.hpp"
#include "eds_parser/report/text.hpp"

namespace takt::learn {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t largest_file = std::uintmax_t{16} << 20U;

bool is_device_file(const fs::path& path) {
  const std::string extension = path.extension().string();
  return same_word(extension, ".eds") || same_word(extension, ".dcf");
}

/// Returns the identity in a file. The values of [DeviceInfo] count only if the dictionary itself
/// has none.
SeenIdentity identity_of(const ObjectDictionary& dictionary) {
  SeenIdentity identity{.device_type = unsigned32_of(dictionary, {0x1000, 0}),
                        .vendor_id = unsigned32_of(dictionary, {0x1018, 1}),
                        .product_code = unsigned32_of(dictionary, {0x1018, 2}),
                        .revision_number = unsigned32_of(dictionary, {0x1018, 3})};
  if (identity.vendor_id == 0) identity.vendor_id = dictionary.device.vendor_number;
  if (identity.product_code == 0) identity.product_code = dictionary.device.product_number;
  if (identity.revision_number == 0) identity.revision_number = dictionary.device.revision_number;
  return identity;
}

}  // namespace

SeenIdentity identity_of(const LearnedValues& values) {
  const auto at = [&](ObjectKey key) {
    return static_cast<std::uint32_t>(values.number_read(key).value_or(0));
  };
  return {.device_type = at({0x1000, 0}),
          .vendor_id = at({0x1018, 1}),
          .product_code = at({0x1018, 2}),
          .revision_number = at({0x1018, 3}),
          .serial_number = at({0x1018, 4})};
}

void DeviceFiles::add_folder(const fs::path& folder, Findings& findings) {
  std::error_code error;
  std::vector<fs::path> paths;
  // Subfolders that can't be opened are skipped, but the folder itself must be open.
  fs::recursive_directory_iterator at;
  if (fs::directory_iterator{folder, error}; !error) {
    at = {folder, fs::directory_options::skip_permission_denied, error};
  }
  for (const fs::recursive_directory_iterator end; !error && at != end; at.increment(error)) {
    std::error_code ignored;
    if (!at->is_regular_file(ignored) || !is_device_file(at->path())) continue;
    if (paths.size() >= most_files || at->file_size(ignored) > largest_file) continue;
    paths.push_back(at->path());
  }
  if (error) {
    findings.push_back({folder.string(), {}, Severity::error, "no-file", error.message()});
  }
  std::ranges::sort(paths);
  Findings ignored;  // a folder may hold files that are no device files
  for (const fs::path& path : paths) add_file(path, ignored);
}

bool DeviceFiles::add_file(const fs::path& file, Findings& findings) {
  const EdsFile eds = read_eds_file(file);
  if (!eds.readable) {
    std::error_code ignored;
    findings.push_back({file.string(),
                        {},
                        Severity::error,
                        "no-device-file",
                        fs::is_directory(file, ignored) ? "is a folder: give folders with --eds-dir"
                                                        : "can't be read as an EDS or DCF"});
    return false;
  }
  files_.push_back({file, identity_of(eds.dictionary)});
  return true;
}

bool DeviceFiles::assign(std::uint8_t node, const fs::path& file, Findings& findings) {
  if (!add_file(file, findings)) return false;
  assigned_[node] = file;
  return true;
}

DeviceFiles::Match DeviceFiles::match(const fs::path& path, std::uint8_t node) {
  EdsFile eds = read_eds_file(path, NodeId::from(node));
  return {.path = path,
          .dictionary = std::make_shared<const ObjectDictionary>(std::move(eds.dictionary))};
}

bool DeviceFiles::add_argument(const std::string& argument, Findings& findings) {
  unsigned id = 0;
  const char* const end = argument.data() + argument.size();
  const auto [equals, error] = std::from_chars(argument.data(), end, id);
  const auto node = NodeId::from(id);
  if (error == std::errc{} && equals != end && *equals == '=' && node) {
    return assign(node->value(), std::string{equals + 1, end}, findings);
  }
  return add_file(argument, findings);
}

std::vector<std::uint8_t> DeviceFiles::assigned() const {
  const auto nodes = assigned_ | std::views::keys;
  return {nodes.begin(), nodes.end()};
}

DeviceFiles::Match DeviceFiles::find(std::uint8_t node, const SeenIdentity& identity) const {
  if (const auto own = assigned_.find(node); own != assigned_.end()) {
    return match(own->second, node);
  }
  if (identity.vendor_id == 0 && identity.product_code == 0) return {};
  const Known* best = nullptr;
  int best_score = 0;
  std::size_t rivals = 0;
  for (const Known& file : files_) {
    if (file.identity.vendor_id != identity.vendor_id ||
        file.identity.product_code != identity.product_code) {
      continue;
    }
    const bool type = file.identity.device_type == identity.device_type;
    if (identity.vendor_id == 0 && !type) continue;
    const bool revision = file.identity.revision_number == identity.revision_number;
    const int score = 1 + (type ? 1 : 0) + (revision ? 2 : 0);
    rivals = score == best_score ? rivals + 1 : score > best_score ? 0 : rivals;
    if (score <= best_score) continue;
    best = &file;
    best_score = score;
  }
  if (best == nullptr) return {};
  Match found = match(best->path, node);
  found.rivals = rivals;
  found.other_revision = identity.revision_number != 0 && best->identity.revision_number != 0 &&
                         identity.revision_number != best->identity.revision_number;
  return found;
}

}  // namespace takt::learn
