#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "apps/learn/learned_bus.hpp"
#include "eds_parser/object_dictionary.hpp"

namespace takt {

/// Identity of a device as far as the recording or a file knows it; 0: unknown.
struct SeenIdentity {
  std::uint32_t device_type = 0;
  std::uint32_t vendor_id = 0;
  std::uint32_t product_code = 0;
  std::uint32_t revision_number = 0;
  std::uint32_t serial_number = 0;
};

/// What the master read from 0x1000 and 0x1018.
SeenIdentity identity_of(const LearnedValues& values);

/// EDS and DCF files among which the devices of a recording are found.
class DeviceFiles {
 public:
  static constexpr std::size_t most_files = 5000;

  /// All of a folder and of the folders in it.
  void add_folder(const std::filesystem::path& folder, Findings& findings);
  /// False: it can't be read; that is told.
  bool add_file(const std::filesystem::path& file, Findings& findings);
  /// `file` is that of this node whatever its identity is.
  bool assign(std::uint8_t node, const std::filesystem::path& file, Findings& findings);

  /// Nodes that have a file by assign().
  std::vector<std::uint8_t> assigned() const;

  struct Match {
    std::filesystem::path path;
    std::shared_ptr<const ObjectDictionary> dictionary;  ///< read with the node's id
    bool other_revision = false;
    std::size_t rivals = 0;  ///< other files that fit as well
  };
  /// The file of a node: as assigned, else by vendor and product; an equal revision wins. `path` is
  /// empty where none fits.
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

}  // namespace takt
