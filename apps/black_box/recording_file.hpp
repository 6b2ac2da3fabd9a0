#pragma once
#include <cstdint>
#include <expected>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"
#include "master/core/event.hpp"
#include "master/rt/replay_port.hpp"

namespace takt {

/// What a recording says of itself.
struct RecordingHead {
  std::string bus{};
  std::string interface{};    ///< it ran on; events name it
  std::string network{};      ///< path of the network file, as it was given
  std::string fingerprint{};  ///< of the plan, see plan_fingerprint()
  std::string reason{};       ///< why it was written
  bool observe = false;       ///< the master only listened
  bool from_start = false;    ///< it begins where the master was started
  std::string follows{};      ///< recording that ends where this one begins, else empty
};

/// An event as it stands in a file.
struct Decision {
  std::int64_t time = 0;  ///< monotonic, ns
  std::uint64_t cycle = 0;
  unsigned node = 0;
  std::string kind{};
  std::int64_t value = 0;
  std::uint32_t detail = 0;
  std::string bytes{};  ///< hex
  std::string text{};

  bool operator==(const Decision&) const = default;
};

Decision to_decision(const BusPlan& plan, const Event& event);

/// A recording as it was read.
struct LoadedRecording {
  RecordingHead head;             ///< of the last part
  std::vector<Recording> parts;   ///< that follow one another
  std::vector<std::string> logs;  ///< paths of their candump logs
  std::vector<Decision> decisions;
  /// What the master knew where the replay begins; empty: it begins with the master's start.
  std::vector<std::uint64_t> checkpoint{};
  std::optional<std::string> fault;  ///< why it can't be replayed, as a sentence
};

/// Another one for each plan that makes the master do something else; neither the names of bus and
/// interface nor the real time that was asked for count.
std::string plan_fingerprint(const BusPlan& plan);

/// Writes `stem.log` (as `candump -L` does), `stem.events.json` and `stem.journal`. `records` are
/// those of a tape. The three have other names until all of them are complete; where one can't be
/// written, none is left behind. An error is a sentence.
std::expected<void, std::string> write_recording(const std::filesystem::path& stem,
                                                 const BusPlan& plan, const RecordingHead& head,
                                                 const std::vector<std::uint64_t>& records);

/// Reads the three files, and those of the recordings that it follows; `file` is any of the three,
/// or the path without ending. Any content is safe.
std::expected<LoadedRecording, std::string> read_recording(const std::filesystem::path& file);

}  // namespace takt
