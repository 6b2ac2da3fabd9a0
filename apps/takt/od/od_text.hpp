#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "apps/takt/od/od_entry.hpp"

namespace takt {

/// Writes objects as a table of lines of at most `width` columns, row by row, so that values can be
/// printed while the next ones are read.
class OdTable {
 public:
  OdTable(const KnownDevice& device, std::size_t width);

  std::string heading() const;
  /// Returns the lines of an entry. Before the first entry of an ARRAY or RECORD, they include the
  /// line of the object.
  std::string row(const OdEntry& entry);

 private:
  std::string cells(const OdEntry& entry, const std::string& value) const;
  std::string continued(const std::string& line, const std::string& value) const;

  const KnownDevice& device_;
  std::size_t width_;
  std::size_t name_width_;
  const Object* group_ = nullptr;  // ARRAY or RECORD of the previous entry
};

/// Returns the value of an entry and its meaning, or the reason why there is no value.
std::string entry_text(const KnownDevice& device, const OdEntry& entry);

/// Returns one JSON document. `live` is true if the values come from the device.
std::string od_json(const KnownDevice& device, const std::vector<OdEntry>& entries, bool live);

}  // namespace takt
