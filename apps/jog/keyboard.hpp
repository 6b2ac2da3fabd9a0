#pragma once
#include <cstdint>
#include <termios.h>

namespace takt {

/// Keys that takt-jog knows.
enum class JogKey : std::uint8_t { none, forward, backward, end, other };

/// Reads the keys of the terminal and switches its echo off. The destructor restores the terminal.
/// stdin must be a terminal.
class Keyboard {
 public:
  Keyboard();
  ~Keyboard();
  Keyboard(const Keyboard&) = delete;
  Keyboard& operator=(const Keyboard&) = delete;

  /// Returns true if stdin is a terminal.
  static bool exists() noexcept;
  /// Returns the next key that has come, or JogKey::none.
  JogKey next();
  /// Discards the keys that have come.
  void forget();
  /// Returns false if the terminal is closed.
  bool open() const noexcept { return open_; }

 private:
  int byte();

  termios before_{};
  bool open_ = true;
};

}  // namespace takt
