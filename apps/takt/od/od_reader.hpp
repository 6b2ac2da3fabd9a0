#pragma once
#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

#include "apps/takt/od/od_entry.hpp"

namespace takt {

/// Reads the values of entries from a device, one after the other. It writes nothing, and it skips
/// entries that have a reason not to be read. It stops after several objects in sequence without an
/// answer, so that a silent device does not cause a time-out for each object.
class OdReader {
 public:
  using Upload = std::function<std::vector<std::byte>(ObjectKey)>;

  /// `upload` returns the value of an object, or throws a Failure.
  explicit OdReader(Upload upload) : upload_{std::move(upload)} {}

  /// Fills `value` or `error`. Passes on a Failure that is not about the object, such as the loss
  /// of the bus.
  void read(OdEntry& entry);
  /// Returns true if the device no longer answers.
  bool silent() const noexcept { return silences_ >= most_silences; }

 private:
  static constexpr int most_silences = 3;

  Upload upload_;
  int silences_ = 0;  // number of objects without an answer, in sequence
};

}  // namespace takt
