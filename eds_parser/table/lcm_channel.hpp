#pragma once
#include <string>
#include <string_view>

namespace takt {

/// `LIFT_IMAGE` of bus "lift" and what "IMAGE": capitals, everything else than letters and digits
/// becomes an underscore. At most 63 characters, LCM's limit.
std::string channel_name(std::string_view bus, std::string_view what);

}  // namespace takt
