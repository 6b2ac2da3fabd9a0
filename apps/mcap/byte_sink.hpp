#pragma once
#include <cstdint>
#include <string_view>

namespace takt::mcap {

/// Takes the bytes of a file, one after the other.
class ByteSink {
 public:
  virtual ~ByteSink() = default;

  /// Makes sure that the next `bytes` bytes can be written. Returns false if there is no room.
  virtual bool reserve(std::uint64_t bytes) = 0;
  /// Appends all bytes. Returns false if that fails; the sink then has none of them.
  virtual bool write(std::string_view bytes) = 0;
};

}  // namespace takt::mcap
