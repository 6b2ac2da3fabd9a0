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

#include "apps/black_box/recording_file.hpp"
#include "master/rt/journal.hpp"

namespace takt {

struct BlackBoxOptions {
  std::filesystem::path folder;
  std::size_t bytes = 16 << 20;  ///< of each of the two tapes
  std::size_t keep = 20;  ///< recordings of this bus; older ones go when a new one is complete
};

/// The black box of a running master: holds the journal of the bus thread and writes it to files
/// after a fault or when asked. A fault is written with what comes in the second after it; one kind
/// of fault of one node at most every five minutes, and no two recordings within ten seconds. Front
/// thread; the files are written by a thread of their own.
class BlackBox {
 public:
  /// A recording is written; `file` is empty where that failed.
  using Say = std::function<void(const std::string& sentence, const std::string& file)>;

  /// An error is a sentence: the folder can't be written. A disk that only takes nothing now is
  /// none: each recording is tried, and what becomes of it is told. `plan` outlives the box.
  static std::expected<std::unique_ptr<BlackBox>, std::string> open(const BlackBoxOptions& options,
                                                                    const BusPlan& plan,
                                                                    RecordingHead head, Say say);
  ~BlackBox();
  BlackBox(const BlackBox&) = delete;
  BlackBox& operator=(const BlackBox&) = delete;

  Journal& journal() noexcept { return journal_; }

  /// Something went wrong: it will be written.
  void on_fault(const std::string& kind, std::uint8_t node, const std::string& text, Time now);
  /// It is to be written as soon as may be.
  void on_request(const std::string& reason, Time now);
  /// Often: begins and ends what is due.
  void serve(Time now);
  /// The bus thread has ended: writes what is due, and `reason` where there is one. Waits for at
  /// most `limit`; false: the writer is still at it, and the destructor would wait for it.
  bool finish(const std::string& reason, Time limit);
  /// The same while the bus thread runs on. Waits for at most `limit`; false: it was not written.
  bool finish_running(const std::string& reason, Time limit);

 private:
  BlackBox(const BlackBoxOptions& options, const BusPlan& plan, RecordingHead head, Say say);

  void ask(const std::string& reason, Time at);
  bool write(const Tape& tape);
  void write_files(const Tape& tape, const RecordingHead& head);
  std::filesystem::path next_stem(const std::string& bus) const;
  void forget_oldest(const std::string& bus) const;
  void end_writing();
  bool await_writer(Time until) const;

  BlackBoxOptions options_;
  const BusPlan& plan_;
  RecordingHead head_;
  Say say_;
  Journal journal_;
  std::map<std::pair<std::string, std::uint8_t>, Time> faults_;  // when each was written last
  std::string reason_;  // of the recording that is due; empty: none
  Time due_ = never;
  Time last_{};          // the newest recording was begun; 0: none was
  bool wanted_ = false;  // the bus thread was asked for its tape
  std::thread writer_;
  std::atomic<bool> writing_{false};
  // The writer's, until writing_ is false:
  std::string previous_;  // recording that ends where the running tape begins
  std::string written_;
  bool failed_ = false;
};

}  // namespace takt
