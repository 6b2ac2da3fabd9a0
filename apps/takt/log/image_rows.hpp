#pragma once
#include <cstdint>
#include <optional>
#include <takt/image_t.hpp>
#include <utility>
#include <vector>

#include "apps/takt/log/log_writer.hpp"

namespace takt::logging {

/// Makes rows from the images of a daemon: joins the parts of an image, picks the recorded signals,
/// and counts the cycles that are missing.
class ImageRows {
 public:
  explicit ImageRows(const std::vector<LoggedSignal>& signals);

  /// Takes an image of the session and the layout of the signals, or a part of one. Returns a row
  /// if the part completes a cycle that is newer than all cycles before. The row is valid until the
  /// next call.
  std::optional<LogRow> take(const image_t& image);

 private:
  // Position in the layout, and column of the log.
  std::vector<std::pair<std::size_t, std::size_t>> columns_;
  std::vector<std::int64_t> raw_;
  std::vector<std::uint8_t> fresh_;
  std::int64_t cycle_ = -1;  // cycle of the parts that have arrived
  std::int16_t next_part_ = 0;
  std::int64_t last_cycle_ = -1;  // cycle of the newest row
};

}  // namespace takt::logging
