#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "eds_parser/table/time.hpp"
#include "master/linux/file_descriptor.hpp"

namespace takt {

/// Writes lines to a file that may not take them: a terminal that is stopped with Ctrl-S, a pipe
/// that nobody reads, a slow or a full disk. A thread of its own does the writing, so that adding a
/// line never waits. Lines that find no room in the queue, or that can't be written, are counted.
/// The line after one that was cut begins on a line of its own.
class LineWriter {
 public:
  static constexpr std::size_t most_waiting = 1 << 20;  ///< bytes

  /// Runs `body` on a thread that nobody joins. Returns false where no thread can be created.
  using StartThread = std::function<bool(std::function<void()> body)>;
  static bool start_detached(std::function<void()> body);

  /// Opens the file to append to it. Returns null where it can't be written; errno says why.
  static std::unique_ptr<LineWriter> open(const std::string& path);
  explicit LineWriter(FileDescriptor file, StartThread start = start_detached);
  /// Does not wait. The lines that were added are still written while the process lives.
  ~LineWriter();
  LineWriter(const LineWriter&) = delete;
  LineWriter& operator=(const LineWriter&) = delete;

  void add(std::string_view line);
  /// Returns the number of lines that were lost since the last call.
  std::uint64_t take_lost();
  /// Waits until all lines are written, at most for `limit`. Returns false where some are not.
  /// Without a thread the caller writes them.
  bool flush(Time limit);
  /// Where no thread could be created, the caller writes what the file takes within `limit`.
  /// Returns false where lines still wait. With a thread, it does nothing and returns true.
  bool write_through(Time limit);

  /// False while no thread could be created. The next line that comes a second or more after the
  /// last attempt tries again; meanwhile lines wait, or the caller writes them.
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
