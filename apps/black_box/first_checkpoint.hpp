#pragma once
#include "apps/black_box/recording_file.hpp"

namespace takt {

/// Leaves out what lies before the first checkpoint, but for the frames. False: there is none.
bool begin_with_checkpoint(LoadedRecording& recording);

}  // namespace takt
