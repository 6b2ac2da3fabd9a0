#include "apps/taktd/event_file.hpp"

#include <algorithm>
#include <utility>

namespace takt {

std::unique_ptr<EventFile> EventFile::open(const std::string& path) {
  std::ofstream file{path, std::ios::app};
  if (!file) return nullptr;
  return std::unique_ptr<EventFile>{new EventFile{std::move(file)}};
}

EventFile::EventFile(std::ofstream file)
    : file_{std::move(file)}, writer_{[this] { write_all(); }} {}

EventFile::~EventFile() {
  {
    const std::lock_guard lock{mutex_};
    ends_ = true;
  }
  changed_.notify_all();
  writer_.join();
}

void EventFile::add(const std::string& line) {
  {
    const std::lock_guard lock{mutex_};
    if (waiting_.size() + line.size() >= most_waiting) {
      ++lost_;
      return;
    }
    waiting_.append(line).push_back('\n');
  }
  changed_.notify_all();
}

std::uint64_t EventFile::take_lost() {
  const std::lock_guard lock{mutex_};
  return std::exchange(lost_, 0);
}

bool EventFile::flush(Time limit) {
  std::unique_lock lock{mutex_};
  return changed_.wait_for(lock, limit, [this] { return waiting_.empty() && !writing_; });
}

void EventFile::write_all() {
  std::unique_lock lock{mutex_};
  for (;;) {
    changed_.wait(lock, [this] { return ends_ || !waiting_.empty(); });
    if (waiting_.empty()) return;
    const std::string lines = std::exchange(waiting_, {});
    writing_ = true;
    lock.unlock();
    file_ << lines << std::flush;
    const bool written = file_.good();
    file_.clear();
    lock.lock();
    writing_ = false;
    if (!written) lost_ += static_cast<std::uint64_t>(std::ranges::count(lines, '\n'));
    changed_.notify_all();
  }
}

}  // namespace takt
