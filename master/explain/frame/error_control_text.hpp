#pragma once
#include <array>
#include <optional>
#include <string>

#include "master/explain/frame/meaning.hpp"
#include "master/wire/frame.hpp"

namespace takt {

/// Describes heartbeats, boot-up messages, and guarding frames. It follows the toggle bit of
/// guarding for each node. CiA 301, 7.2.8.3.
class ErrorControlText {
 public:
  FrameMeaning meaning(unsigned node, const std::string& name, const Frame& frame);

 private:
  struct Guarding {
    bool asked = false;            // true if a request has no answer so far
    std::optional<bool> toggle{};  // toggle bit of the newest answer; empty if unknown
  };

  FrameMeaning request(unsigned node, const std::string& name);
  FrameMeaning answer(unsigned node, const std::string& name, std::uint8_t byte);

  std::array<Guarding, 128> nodes_{};
};

}  // namespace takt
