#pragma once

namespace takt {

/// While an Interrupt exists, the first SIGINT (Ctrl-C) or SIGTERM only sets asked(), so that the
/// program can end in order. A second one ends the program.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  static bool asked() noexcept;
};

}  // namespace takt
