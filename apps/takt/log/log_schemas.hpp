#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "apps/takt/log/logged_signal.hpp"

namespace takt::logging {

/// Returns the name of the field that has the number of the cycle: `cycle`, with underscores if a
/// node has this name.
std::string cycle_field(const std::vector<LoggedSignal>& signals);

/// Returns the JSON schema of an image: an object for each node, with objects and units as
/// descriptions.
nlohmann::json image_schema(const std::vector<LoggedSignal>& signals);
/// JSON schema of an event: the fields of foxglove.Log, which viewers show in their panels of
/// events. `file` is the kind of the event, `line` the cycle.
nlohmann::json event_schema();
/// Returns the JSON schema of a frame.
nlohmann::json frame_schema();

}  // namespace takt::logging
