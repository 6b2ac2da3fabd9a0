#pragma once
#include <atomic>
#include <cstdint>
#include <expected>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <utility>

#include "master/black_box/recording_file.hpp"
#include "master/rt/journal/journal.hpp"

namespace takt {

/// Options of a BlackBox.
struct BlackBoxOptions {
  std::filesystem::path folder;
  std::size_t bytes = 16 << 20;  ///< size of each of the two tapes
  /// Number of recordings of this bus to keep. Older ones are removed after a new one is complete.
  std::size_t keep = 20;
};

/// Black box of a running master. It holds the journal of the bus thread and writes the journal to
/// files after a fault or on request. The recording of a fault includes the second after the fault.
/// The same kind of fault of the same node is written at most every five minutes, and recordings
/// are at least ten seconds apart. All calls come from the front thread; a separate thread writes
/// the files.
class BlackBox {
 public:
  /// Reports that a recording was written. `file` is empty if the recording failed.
  using Say = std::function<void(const std::string& sentence, const std::string& file)>;

  /// Returns an error sentence if the folder can't be written. A disk that only refuses data for
  /// the moment is no error: the black box tries each recording and reports the result. `plan` must
  /// outlive the black box.
  static std::expected<std::unique_ptr<BlackBox>, std::string> open(const BlackBoxOptions& options,
                                                                    const BusPlan& plan,
                                                                    RecordingHead head, Say say);
  ~BlackBox();
  BlackBox(const BlackBox&) = delete;
  BlackBox& operator=(const BlackBox&) = delete;

  Journal& journal() noexcept { return journal_; }

  /// Schedules a recording of a fault.
  void on_fault(const std::string& kind, std::uint8_t node, const std::string& text, Time now);
  /// Schedules a recording as soon as possible.
  void on_request(const std::string& reason, Time now);
  /// Begins and ends the recordings that are due. The front thread calls this function often.
  void serve(Time now);
  /// Writes a last recording after the bus thread has ended, if one is due or if `reason` is not
  /// empty. Waits for at most `limit`. Returns false if the writer has not ended by then; the
  /// destructor would wait for the writer.
  bool finish(const std::string& reason, Time limit);
  /// Writes a last recording while the bus thread is still running. Waits for at most `limit`.
  /// Returns false if the recording was not written.
  bool finish_running(const std::string& reason, Time limit);

 private:
  BlackBox(const BlackBoxOptions& options, const BusPlan& plan, RecordingHead head, Say say);

  void ask(const std::string& reason, Time at);
  bool write(const Tape& tape);
  void write_files(const Tape& tape, const RecordingHead& head);
  std::filesystem::path next_stem(const std::string& bus) const;
  void forget_oldest(const std::string& bus) const;
  void end_writing();
  bool end_writer(Time until);

  BlackBoxOptions options_;
  const BusPlan& plan_;
  RecordingHead head_;
  Say say_;
  Journal journal_;
  // Time of the last fault of each kind and node that was to be recorded.
  std::map<std::pair<std::string, std::uint8_t>, Time> faults_;
  std::string reason_;  // reason of the recording that is due; empty if none is due
  Time due_ = never;
  Time last_{};          // start of the newest recording; 0 if there is none
  bool wanted_ = false;  // true if the bus thread was asked for its tape
  std::thread writer_;
  std::atomic<bool> writing_{false};
  // Only the writer may use the following members until writing_ is false.
  std::string previous_;  // recording that ends where the current tape begins
  std::string written_;
  bool failed_ = false;
};

}  // namespace takt
