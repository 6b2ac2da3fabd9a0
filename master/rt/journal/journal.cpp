#include "master/rt/journal/journal.hpp"

#include <algorithm>

namespace takt {

std::vector<std::uint64_t> Tape::read() const {
  const std::uint64_t size = words_.size();
  const std::uint64_t end = lap_ * size + at_;
  std::uint64_t begin = 0;
  if (!whole()) {
    begin = end;
    for (const std::uint64_t mark : begins_) {
      // The newest record may have been written over the beginning of the oldest.
      if (mark != 0 && mark - 1 + size >= end) begin = std::min(begin, mark - 1);
    }
  }
  const auto at = [this](std::uint64_t word) {
    return words_.begin() + static_cast<std::ptrdiff_t>(word);
  };
  std::vector<std::uint64_t> records;
  records.reserve(end - begin);
  if (begin / size != lap_) records.assign(at(begin % size), at(end_of_lap_));
  const std::uint64_t from = begin / size == lap_ ? begin % size : 0;
  records.insert(records.end(), at(from), at(at_));
  return records;
}

}  // namespace takt
