#pragma once
#include <cstddef>
#include <span>

#include "eds_parser/table/ids.hpp"
#include "eds_parser/table/time.hpp"
#include "master/sim/abort.hpp"

namespace takt::sim {

/// The object dictionary as an SDO server sees it: every check is behind it.
class Dictionary {
 public:
  virtual ~Dictionary() = default;
  /// `data` stays valid until the next call.
  virtual Abort read(ObjectKey key, Time now, std::span<const std::byte>& data) noexcept = 0;
  virtual Abort write(ObjectKey key, Time now, std::span<const std::byte> data) noexcept = 0;
  /// Bytes of a number, 0 for strings and domains; an abort code where it can't be written at all.
  virtual Abort width(ObjectKey key, std::size_t& bytes) const noexcept = 0;
  /// A fault: requests for this object are not answered.
  virtual bool is_mute(ObjectKey key) const noexcept = 0;
};

}  // namespace takt::sim
