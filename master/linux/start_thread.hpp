#pragma once
#include <expected>
#include <system_error>
#include <thread>
#include <utility>

namespace takt {

/// A thread that runs `body`, or the errno that says why the machine has none to give: its limit of
/// processes (RLIMIT_NPROC, TasksMax of systemd) or its memory.
template <class Body>
std::expected<std::thread, int> start_thread(Body&& body) noexcept {
  try {
    return std::thread{std::forward<Body>(body)};
  } catch (const std::system_error& error) {
    return std::unexpected{error.code().value()};
  }
}

}  // namespace takt
