#pragma once
#include <string>
#include <string_view>

#include "eds_parser/report/source.hpp"
#include "eds_parser/specification/network_spec.hpp"

namespace takt {

/// Reads the text of a network file (or of a bus.yml of Lely's dcfgen / ros2_canopen). Appends all
/// errors to `findings`. The result holds all parts that could be read. No content makes it throw.
NetworkSpec read_network(std::string_view text, const std::string& file, Findings& findings);

}  // namespace takt
