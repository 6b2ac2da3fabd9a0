#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "eds_parser/source.hpp"

namespace takt {

enum class KeyFate : std::uint8_t {
  used,
  ignored,     ///< other readers use it
  suspicious,  ///< used, but hardly what was meant
  wrong,       ///< the file can't run with it
};

std::string_view name(KeyFate fate) noexcept;

/// One key of a file, or one entry of a list of objects.
struct ImportedKey {
  std::string path;   ///< "nodes.arm.tpdo.1.cob_id"
  std::string value;  ///< as written
  SourcePos pos;
  KeyFate fate = KeyFate::used;
  std::string why;  ///< what it becomes, or why it does not
};

struct ImportReport {
  std::vector<ImportedKey> keys;     ///< in the order of the file
  Findings others;                   ///< of no key: device files, what is missing
  bool usable = false;               ///< taktd would run it
  std::vector<std::string> unasked;  ///< what taktd does besides that other readers do not

  std::size_t count(KeyFate fate) const noexcept;
};

/// What takt makes of each key of a bus.yml.
ImportReport import_report(const std::filesystem::path& path);

}  // namespace takt
