#pragma once
#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

#include "apps/takt/od/od_entry.hpp"

namespace takt {

/// Reads the values of entries from a device, one after the other. It only reads, and it leaves out
/// entries with a reason not to be read. After several objects in sequence without an answer it
/// reads no more, so that a silent device does not cost a time-out for each object.
class OdReader {
 public:
  using Upload = std::function<std::vector<std::byte>(ObjectKey)>;

  /// `upload` returns the value of an object, or throws a Failure.
  explicit OdReader(Upload upload) : upload_{std::move(upload)} {}

  /// Fills `value` or `error`. Passes on a Failure that is not about the object, such as a bus that
  /// is gone.
  void read(OdEntry& entry);
  /// Returns true if the device has stopped to answer.
  bool silent() const noexcept { return silences_ >= most_silences; }

 private:
  static constexpr int most_silences = 3;

  Upload upload_;
  int silences_ = 0;  // objects without an answer, in sequence
};

}  // namespace takt
