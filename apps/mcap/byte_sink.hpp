#pragma once
#include <cstdint>
#include <string_view>

namespace takt::mcap {

/// The destination of the bytes of a file, in their order.
class ByteSink {
 public:
  virtual ~ByteSink() = default;

  /// Makes sure that the next `bytes` bytes can be written. Returns false if there is no room.
  virtual bool reserve(std::uint64_t bytes) = 0;
  /// Appends all bytes. Returns false if that fails; in this case none of the bytes is in the sink.
  virtual bool write(std::string_view bytes) = 0;
};

}  // namespace takt::mcap
