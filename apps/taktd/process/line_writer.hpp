#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "eds_parser/values/time.hpp"
#include "master/linux/file_descriptor.hpp"

namespace takt {

/// Writes lines to a file that may not accept them: a terminal that is stopped with Ctrl-S, a pipe
/// without a reader, a slow or full disk. A separate thread writes, so that adding a line never
/// waits. The writer counts lines that do not fit into the queue or cannot be written. After a line
/// that was cut, the next one starts on a new line.
class LineWriter {
 public:
  static constexpr std::size_t most_waiting = 1 << 20;  ///< limit of the queue in bytes

  /// Runs `body` on a detached thread. Returns false if no thread can be created.
  using StartThread = std::function<bool(std::function<void()> body)>;
  static bool start_detached(std::function<void()> body);

  /// Opens the file for appending. Returns null and sets errno if the file cannot be opened.
  static std::unique_ptr<LineWriter> open(const std::string& path);
  explicit LineWriter(FileDescriptor file, StartThread start = start_detached);
  /// Does not wait. The thread still writes the lines in the queue while the process lives.
  ~LineWriter();
  LineWriter(const LineWriter&) = delete;
  LineWriter& operator=(const LineWriter&) = delete;

  void add(std::string_view line);
  /// Returns the number of lines that were lost since the last call.
  std::uint64_t take_lost();
  /// Waits for at most `limit` until all lines are written. Returns false if some are not. Without
  /// a thread, the calling thread writes them.
  bool flush(Time limit);
  /// If no thread could be created, writes from the calling thread what the file accepts within
  /// `limit`, and returns false if lines remain. With a thread, does nothing and returns true.
  bool write_through(Time limit);

  /// Returns false as long as no thread could be created. The first add() a second or more after
  /// the last attempt tries again. Meanwhile the lines wait, or the caller writes them.
  bool has_thread() const noexcept { return has_thread_; }

 private:
  struct State;
  void ensure_thread();

  std::shared_ptr<State> state_;  // the thread, which may outlive this object, shares it
  StartThread start_;
  bool has_thread_ = false;
  Time next_try_{};
};

}  // namespace takt
