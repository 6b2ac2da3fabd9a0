#pragma once
#include <filesystem>
#include <string>

#include "apps/import/import_report.hpp"

namespace takt {

/// What becomes of a project file of CiA 306-3, and the network file for it.
struct ImportedNodelist {
  ImportReport report;  ///< `usable`: there is a network file
  std::string yaml;
};

/// Network `number` of a nodelist.cpj ([Topology], [Topology2] ...). Paths in the result are
/// relative to `folder`, where it is going to be.
ImportedNodelist import_nodelist(const std::filesystem::path& cpj, unsigned number,
                                 const std::filesystem::path& folder);

}  // namespace takt
