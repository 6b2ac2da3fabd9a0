#pragma once
#include <condition_variable>
#include <cstdint>
#include <fstream>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "eds_parser/table/time.hpp"

namespace takt {

/// A file of lines, written by a thread of its own: a disk that stalls keeps nobody waiting who
/// adds a line. What does not fit into the queue, or can't be written, is counted.
class EventFile {
 public:
  static constexpr std::size_t most_waiting = 1 << 20;  ///< bytes

  /// Appends. Null: the file can't be written.
  static std::unique_ptr<EventFile> open(const std::string& path);
  /// Waits for the writer, however long it takes.
  ~EventFile();
  EventFile(const EventFile&) = delete;
  EventFile& operator=(const EventFile&) = delete;

  /// Never waits for the disk.
  void add(const std::string& line);
  /// Lines that were lost since the last call.
  std::uint64_t take_lost();
  /// False: what was added is not all through after `limit`.
  bool flush(Time limit);

 private:
  explicit EventFile(std::ofstream file);

  void write_all();

  std::ofstream file_;  // the writer's
  std::mutex mutex_;    // of all below
  std::condition_variable changed_;
  std::string waiting_;  // whole lines
  std::uint64_t lost_ = 0;
  bool writing_ = false;
  bool ends_ = false;
  std::thread writer_;
};

}  // namespace takt
