#pragma once
#include "master/black_box/recording_file.hpp"

namespace takt {

/// Removes everything before the first checkpoint, except the frames. Returns false if the
/// recording has no checkpoint.
bool begin_with_checkpoint(LoadedRecording& recording);

}  // namespace takt
