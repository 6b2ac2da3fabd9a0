#pragma once
#include <cstddef>

#include "eds_parser/values/time.hpp"

namespace takt {

/// Shows the progress of a file transfer on stderr: as one line that is overwritten on a terminal,
/// otherwise as a new line every two seconds.
class TransferProgress {
 public:
  TransferProgress();

  /// A `total` of 0 means unknown.
  void show(std::size_t done, std::size_t total);
  void finish(std::size_t bytes);

 private:
  Time began_;
  Time next_;
  bool terminal_;
  bool shown_ = false;
};

}  // namespace takt
