#pragma once
#include <string>
#include <string_view>

namespace takt {

/// Returns the LCM channel `LIFT_IMAGE` for bus "lift" and `what` "IMAGE". The name of the bus is
/// written in capitals, and all its characters except letters and digits become underscores. The
/// result has at most 63 characters, which is LCM's limit.
std::string channel_name(std::string_view bus, std::string_view what);

}  // namespace takt
