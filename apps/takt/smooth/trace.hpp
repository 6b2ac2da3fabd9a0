#pragma once
#include <istream>
#include <string>
#include <vector>

#include "apps/takt/learn/recording.hpp"
#include "eds_parser/values/time.hpp"
#include "master/wire/frame.hpp"

namespace takt::smooth {

/// A recording with the times of its frames, and the settings of the devices that it shows.
struct Trace {
  learn::LearnedBus bus;
  std::vector<StampedFrame> frames;  ///< without error frames; times count from the first frame
                                     ///< and always increase
  Time resolution{};                 ///< resolution of the time stamps
  bool with_times = true;            ///< false if a frame has no time stamp
  bool cut = false;                  ///< true if the recording has more frames than are kept
};

/// Reads a recording of candump, PCAN, Vector or python-can. Frames of interfaces other than
/// `interface` are left out; empty selects that of the first frame.
Trace read_trace(std::istream& in, const std::string& name, const std::string& interface);

/// Makes a Trace line by line.
class TraceBuilder {
 public:
  static constexpr std::size_t most_frames = 20'000'000;

  TraceBuilder(std::string name, const std::string& interface);
  /// Adds a line of a recording.
  void add(const std::string& text);
  Trace take();

 private:
  void keep(const Frame& frame, const std::string& stamp);

  std::string interface_;
  learn::Recording recording_;
  RecordedLines lines_;
  std::uint32_t line_ = 0;
  Trace trace_;
  std::int64_t first_us_ = 0;
  std::int64_t divisor_us_ = 0;
};

}  // namespace takt::smooth
