#pragma once
#include <string>

namespace takt {

/// Returns the path of the frames of a recording of the black box if `file` is one of its files.
/// Returns any other path unchanged.
std::string log_of_recording(const std::string& file);

/// Returns the path of the events that belong to a log of frames. There need not be such a file.
std::string events_file_of(const std::string& log);

/// Returns the network file that the recording names, at its path or in the folder of the log.
/// Empty if the log belongs to no recording of the black box.
std::string network_of_recording(const std::string& log);

}  // namespace takt
