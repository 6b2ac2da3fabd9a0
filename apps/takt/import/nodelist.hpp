#pragma once
#include <filesystem>
#include <string>

#include "apps/takt/import/import_report.hpp"

namespace takt {

/// Result of the import of a project file of CiA 306-3.
struct ImportedNodelist {
  ImportReport report;  ///< `usable` is true if there is a network file
  std::string yaml;     ///< text of the network file
};

/// Imports network `number` of a nodelist.cpj ([Topology], [Topology2] ...). Paths in the network
/// file are relative to `folder`, in which the user will store it.
ImportedNodelist import_nodelist(const std::filesystem::path& cpj, unsigned number,
                                 const std::filesystem::path& folder);

}  // namespace takt
