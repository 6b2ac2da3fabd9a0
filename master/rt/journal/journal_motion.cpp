#include "master/rt/journal/journal_motion.hpp"

#include "master/core/kept_state.hpp"

namespace takt {
namespace {

std::size_t words_of(motion::MotionMessage& message) noexcept {
  StateSize size;
  message.keep(size);
  return size.count();
}

}  // namespace

void put_motion(Journal& journal, motion::MotionMessage& message) noexcept {
  const std::size_t count = words_of(message);
  std::uint64_t* const room = journal.claim(Mark::motion, count, count);
  if (room == nullptr) return;
  StateWriter writer{room};
  message.keep(writer);
}

bool get_motion(std::span<const std::uint64_t> words, motion::MotionMessage& message) noexcept {
  message = {};
  StateReader reader{words};
  message.keep(reader);
  return message.kind <= motion::MessageKind::points && words.size() == words_of(message);
}

}  // namespace takt
