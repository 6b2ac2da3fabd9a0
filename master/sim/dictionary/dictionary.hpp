#pragma once
#include <cstddef>
#include <span>

#include "eds_parser/values/ids.hpp"
#include "eds_parser/values/time.hpp"
#include "master/sim/dictionary/abort.hpp"

namespace takt::sim {

/// The object dictionary from the view of an SDO server. The implementation makes every check.
class Dictionary {
 public:
  virtual ~Dictionary() = default;
  /// `data` stays valid until the next call.
  virtual Abort read(ObjectKey key, Time now, std::span<const std::byte>& data) noexcept = 0;
  virtual Abort write(ObjectKey key, Time now, std::span<const std::byte> data) noexcept = 0;
  /// Sets `bytes` to the size of a number, or to 0 for strings and domains. Returns an abort code
  /// if the object can't be written at all.
  virtual Abort width(ObjectKey key, std::size_t& bytes) const noexcept = 0;
  /// Returns true if a fault suppresses the answers to requests for this object.
  virtual bool is_mute(ObjectKey key) const noexcept = 0;
};

}  // namespace takt::sim
