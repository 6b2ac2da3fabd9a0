#pragma once
#include <string>
#include <string_view>

#include "eds_parser/network_spec.hpp"
#include "eds_parser/source.hpp"

namespace takt {

/// Text of a network file (or of a bus.yml of Lely's dcfgen / ros2_canopen) -> NetworkSpec. All
/// errors are appended to `findings`; what could be read is in the result. Never throws on content.
NetworkSpec read_network(std::string_view text, const std::string& file, Findings& findings);

}  // namespace takt
