#pragma once
#include <string>

#include "eds_parser/table/bus_plan.hpp"

namespace takt {

struct DbcOptions {
  /// True: statuswords and controlwords are written as named bits. False: each is one value. Both
  /// at once is not possible, because most readers of DBC refuse signals that overlap.
  bool word_bits = true;
};

/// Returns the frames of a bus as a DBC file: PDOs as the master configures them, SYNC, EMCY,
/// heartbeats. Physical values are in SI units, as takt shows them. Signals have the names of the
/// objects. If a name exceeds the 32 characters that DBC allows, the long name is an attribute.
/// Characters outside Windows-1252 become `?`.
std::string to_dbc(const BusPlan& plan, const DbcOptions& options = {});

}  // namespace takt
