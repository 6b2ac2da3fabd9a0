#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "eds_parser/table/time.hpp"
#include "master/linux/file_descriptor.hpp"

namespace takt {

/// Lines on their way to where they may not be taken: a terminal that is stopped with Ctrl-S, a
/// pipe that nobody reads, a slow or a full disk. A thread of its own writes; who adds a line never
/// waits for it. Lines that find no room in the queue, or that can't be written, are counted. A
/// line that was cut never spoils the next one.
class LineWriter {
 public:
  static constexpr std::size_t most_waiting = 1 << 20;  ///< bytes

  /// Runs `body` on a thread that nobody joins. False: there is no thread to be had.
  using StartThread = std::function<bool(std::function<void()> body)>;
  static bool start_detached(std::function<void()> body);

  /// Appends to the file. Null: it can't be written, and errno says why.
  static std::unique_ptr<LineWriter> open(const std::string& path);
  explicit LineWriter(FileDescriptor file, StartThread start = start_detached);
  /// Waits for nothing. What was added is still written while the process lives.
  ~LineWriter();
  LineWriter(const LineWriter&) = delete;
  LineWriter& operator=(const LineWriter&) = delete;

  void add(std::string_view line);
  /// The number of lines that were lost since the last call.
  std::uint64_t take_lost();
  /// False: what was added is not all through after `limit`. Without a thread the caller writes.
  bool flush(Time limit);
  /// Where no thread could be created, the caller writes what the file takes within `limit`. False:
  /// something still waits. With a thread, it does nothing and is true.
  bool write_through(Time limit);

  /// False: no thread could be created so far. It is tried again with each line that comes a second
  /// or more after the last try; meanwhile lines wait, or the caller writes them.
  bool has_thread() const noexcept { return has_thread_; }

 private:
  struct State;
  void ensure_thread();

  std::shared_ptr<State> state_;  // also held by the thread, which may outlive this
  StartThread start_;
  bool has_thread_ = false;
  Time next_try_{};
};

}  // namespace takt
