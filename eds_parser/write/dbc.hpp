#pragma once
#include <string>

#include "eds_parser/table/bus_plan.hpp"

namespace takt {

struct DbcOptions {
  /// Statuswords and controlwords as their bits by name; false: as one value. (One signal over
  /// another is an error for most readers of DBC, so it is one or the other.)
  bool word_bits = true;
};

/// The frames of a bus as a DBC: PDOs as the master configures them, SYNC, EMCY, heartbeats.
/// Physical values are SI as takt shows them. Signal names are the objects'; where they exceed the
/// 32 characters that DBC allows, the long name is an attribute. Text beyond Windows-1252 becomes
/// `?`.
std::string to_dbc(const BusPlan& plan, const DbcOptions& options = {});

}  // namespace takt
