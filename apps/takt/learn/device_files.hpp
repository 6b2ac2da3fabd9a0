#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <vector>

#include "apps/takt/learn/learned_bus.hpp"
#include "eds_parser/dictionary/object_dictionary.hpp"

namespace takt::learn {

/// Identity of a device as far as the recording or a file shows it. 0 means unknown.
struct SeenIdentity {
  std::uint32_t device_type = 0;
  std::uint32_t vendor_id = 0;
  std::uint32_t product_code = 0;
  std::uint32_t revision_number = 0;
  std::uint32_t serial_number = 0;
};

/// Returns the identity that the master read from 0x1000 and 0x1018.
SeenIdentity identity_of(const LearnedValues& values);

/// EDS and DCF files in which the devices of a recording are looked up.
class DeviceFiles {
 public:
  static constexpr std::size_t most_files = 5000;

  /// Adds all files of a folder and of its subfolders.
  void add_folder(const std::filesystem::path& folder, Findings& findings);
  /// Adds one file. Returns false, and adds a finding, if the file can't be read.
  bool add_file(const std::filesystem::path& file, Findings& findings);
  /// Assigns a file to a node, whatever the identity of the node is. Returns false, and adds a
  /// finding, if the file can't be read.
  bool assign(std::uint8_t node, const std::filesystem::path& file, Findings& findings);
  /// Adds a file that is given on a command line as `FILE`, or assigns it as `5=FILE` to one
  /// node-ID. Returns false, and adds a finding, if the file can't be read.
  bool add_argument(const std::string& argument, Findings& findings);

  /// Returns the nodes that assign() has given a file.
  std::vector<std::uint8_t> assigned() const;

  /// A file that fits a node.
  struct Match {
    std::filesystem::path path;
    std::shared_ptr<const ObjectDictionary> dictionary;  ///< dictionary for the node-ID of the node
    bool other_revision = false;  ///< true if the device has another revision number
    std::size_t rivals = 0;       ///< number of other files that fit as well
  };
  /// Finds the file of a node: the assigned one, or else by vendor-ID and product code. An equal
  /// revision number takes precedence. `path` is empty if no file fits.
  Match find(std::uint8_t node, const SeenIdentity& identity) const;

 private:
  struct Known {
    std::filesystem::path path;
    SeenIdentity identity;
  };
  static Match match(const std::filesystem::path& path, std::uint8_t node);

  std::vector<Known> files_;
  std::map<std::uint8_t, std::filesystem::path> assigned_;
};

}  // namespace takt::learn
