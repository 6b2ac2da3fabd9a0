#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "apps/plot/plot.hpp"

namespace takt {

/// Records the changes of the values of a LogicProgram, for a picture. The memory is bounded: after
/// `most_changes` nothing more is recorded, and the picture states this.
class LogicTrace {
 public:
  static constexpr std::size_t most_changes = 20'000;

  /// Takes the values of one image; `time` is that of the bus in seconds. Each call has the same
  /// number of values.
  void take(double time, const std::vector<double>& values);
  /// Returns a picture with a low panel for each value.
  Plot plot(std::string title, const std::vector<std::string>& names) const;

 private:
  struct Change {
    double time;
    std::vector<double> values;
  };
  std::vector<Change> changes_;
  double end_ = 0.0;
};

}  // namespace takt
