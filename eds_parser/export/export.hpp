#pragma once
#include <string>

#include "eds_parser/lcm/typed_message.hpp"
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

/// Returns the image layout as a C++ header without dependencies: positions of all signals by node
/// and name, names, units, scales, and the layout hash. image_t repeats this hash, so that an
/// application can detect that it was built for another network.
std::string to_cpp_header(const BusPlan& plan);

/// Returns a message type in the format of lcm-gen. Units and objects are comments.
std::string to_lcm(const TypedMessage& message, const BusPlan& plan);

}  // namespace takt
