#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "eds_parser/report/source.hpp"

namespace takt {

/// Result of the import for one key.
enum class KeyUse : std::uint8_t {
  used,        ///< takt uses the key.
  ignored,     ///< Only other readers use the key.
  suspicious,  ///< takt uses the key, but the result is hardly what the author meant.
  wrong,       ///< taktd can't run the file with this key.
};

std::string_view name(KeyUse use) noexcept;

/// One key of a file, or one entry of a list of objects.
struct ImportedKey {
  std::string path;   ///< "nodes.arm.tpdo.1.cob_id"
  std::string value;  ///< as written
  SourcePos pos;
  KeyUse use = KeyUse::used;
  std::string why;  ///< meaning of the key in takt, or the reason why takt does not use it
};

/// Report on the import of a file.
struct ImportReport {
  std::vector<ImportedKey> keys;  ///< keys in the order of the file
  Findings others;                ///< findings that concern no key: device files, missing entries
  bool usable = false;            ///< true if taktd can run the file
  std::vector<std::string> unasked;  ///< actions of taktd that other readers do not take

  /// Returns the number of keys with this result.
  std::size_t count(KeyUse use) const noexcept;
};

/// Reports how takt uses each key of a bus.yml.
ImportReport import_report(const std::filesystem::path& path);

}  // namespace takt
