#pragma once
#include <cstdint>
#include <istream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "apps/takt/learn/learned_bus.hpp"
#include "master/trace/candump_line.hpp"
#include "master/trace/recorded_lines.hpp"

namespace takt::learn {

/// Learns a bus from a recording, frame by frame. Its memory is bounded for any recording.
class Recording {
 public:
  /// Frames of interfaces other than `interface` are left out. Empty selects the interface of the
  /// first frame that is no error frame.
  Recording(std::string file, std::string interface);

  /// Adds one line of the recording. `line` is its number, from 1 on.
  void add(std::string_view text, std::uint32_t line);
  /// Ends the recording and returns the result.
  LearnedBus take();

 private:
  struct EarlyErrors {
    std::string interface;
    std::uint64_t count = 0;
  };

  void early_error(const std::string& interface);
  void choose(std::string interface);
  void foreign(const std::string& interface, std::uint64_t frames);
  void frame(const CandumpLine& line);
  void nmt(const Frame& frame);
  void reset(LearnedNode& node, bool whole_node);
  void start(LearnedNode& node, bool by_name);
  void error_control(std::uint8_t id, const Frame& frame);
  void transfer(LearnedNode& node, const std::optional<SeenTransfer>& transfer);
  void write(LearnedNode& node, const SeenTransfer& transfer);
  void other(const Frame& frame);
  LearnedNode& node(std::uint8_t id);
  LearnedBoot& boot(LearnedNode& node);
  void announce(Severity severity, std::string_view rule, std::uint32_t line, std::string message);

  LearnedBus bus_;
  std::uint32_t line_ = 0;
  RecordedLines lines_;
  bool all_reset_ = false;  // true if the newest reset of all nodes was NMT reset node
  std::uint64_t strange_ = 0;
  std::uint64_t foreign_ = 0;   // frames of other interfaces
  std::uint64_t backward_ = 0;  // frames with an earlier time than the frame before
  std::string foreign_name_;
  std::vector<EarlyErrors> early_;  // error frames before an interface is chosen
  std::optional<std::int64_t> us_;
  std::optional<std::int64_t> first_us_;
};

/// Reads a recording line by line. Only the first 512 characters of a line count, which is more
/// than candump writes.
LearnedBus read_recording(std::istream& in, const std::string& name, const std::string& interface);

}  // namespace takt::learn
