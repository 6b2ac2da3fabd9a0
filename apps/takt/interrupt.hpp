#pragma once

namespace takt {

/// Ctrl-C asks for an end in order while one of these lives; a second one ends the program.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  static bool asked() noexcept;
};

}  // namespace takt
