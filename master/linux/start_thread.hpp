#pragma once
#include <expected>
#include <system_error>
#include <thread>
#include <utility>

namespace takt {

/// Starts a thread that runs `body`. Returns the errno if the machine refuses: its limit of
/// processes (RLIMIT_NPROC, TasksMax of systemd) or its memory is exhausted.
template <class Body>
std::expected<std::thread, int> start_thread(Body&& body) noexcept {
  try {
    return std::thread{std::forward<Body>(body)};
  } catch (const std::system_error& error) {
    return std::unexpected{error.code().value()};
  }
}

}  // namespace takt
