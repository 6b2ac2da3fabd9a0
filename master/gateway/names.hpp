#pragma once
#include <string>
#include <string_view>

namespace takt {

/// `LIFT_IMAGE` of bus "lift" and what "IMAGE": capitals, everything else than letters and digits
/// becomes an underscore. At most 63 characters, LCM's limit.
std::string channel_name(std::string_view bus, std::string_view what);

/// The bus of a channel that ends in `_what`; empty where it does not.
std::string_view bus_of_channel(std::string_view channel, std::string_view what) noexcept;

/// A pattern for LCM subscriptions that matches this channel of any bus.
std::string any_bus(std::string_view what);

}  // namespace takt
