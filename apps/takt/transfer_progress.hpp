#pragma once
#include <cstddef>

#include "eds_parser/table/time.hpp"

namespace takt {

/// How far a file is, on stderr: one line that is written over on a terminal, a line now and then
/// elsewhere.
class TransferProgress {
 public:
  TransferProgress();

  /// `total` 0: not known.
  void show(std::size_t done, std::size_t total);
  void finish(std::size_t bytes);

 private:
  Time began_;
  Time next_;
  bool terminal_;
  bool shown_ = false;
};

}  // namespace takt
