#pragma once
#include <cstdint>
#include <expected>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"
#include "master/core/event.hpp"
#include "master/rt/journal/replay_port.hpp"

namespace takt {

/// Properties of a recording, as its file states them.
struct RecordingHead {
  std::string bus{};
  std::string interface{};    ///< interface of the bus; events name it
  std::string network{};      ///< path of the network file, as it was given
  std::string fingerprint{};  ///< fingerprint of the plan, see plan_fingerprint()
  std::string reason{};       ///< reason of the recording
  bool observe = false;       ///< true if the master only listened
  bool from_start = false;    ///< true if the recording begins with the start of the master
  /// Recording that ends at the beginning of this one; empty if there is none.
  std::string follows{};
};

/// An event in the form in which the file holds it.
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

/// A recording that was read from its files, together with the recordings that it follows.
struct LoadedRecording {
  RecordingHead head;             ///< head of the last part
  std::vector<Recording> parts;   ///< parts in the order of time
  std::vector<std::string> logs;  ///< paths of the candump logs of the parts
  std::vector<Decision> decisions;
  /// State of the master at the point where the replay begins. Empty if the replay begins with the
  /// start of the master.
  std::vector<std::uint64_t> checkpoint{};
  std::optional<std::string> fault;  ///< reason why the recording can't be replayed, a sentence
};

/// Removes everything before the first checkpoint, except the frames. Returns false if the
/// recording has no checkpoint.
bool begin_with_checkpoint(LoadedRecording& recording);

/// Writes `stem.log` (in the format of `candump -L`), `stem.events.json` and `stem.journal`.
/// `records` are the records of a tape. The three files have other names until all of them are
/// complete; if one can't be written, none is left behind. On failure, returns a sentence.
std::expected<void, std::string> write_recording(const std::filesystem::path& stem,
                                                 const BusPlan& plan, const RecordingHead& head,
                                                 const std::vector<std::uint64_t>& records);

/// Returns the path of a recording without the ending of one of its three files. A path that has
/// none of these endings is returned as it is.
std::string recording_stem(const std::string& file);

/// Reads the three files of a recording, and those of the recordings that it follows. `file` is any
/// of the three files, or their path without ending. The files may have any content. On failure,
/// returns a sentence.
std::expected<LoadedRecording, std::string> read_recording(const std::filesystem::path& file);

}  // namespace takt
