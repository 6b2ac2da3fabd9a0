#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"
#include "master/core/event.hpp"

namespace takt {

/// One EMCY frame as it was on the wire, with its time.
struct EmcyRecord {
  std::int64_t utime = 0;  ///< us since 1970
  std::array<std::uint8_t, 8> bytes{};

  std::uint16_t code() const noexcept {
    return static_cast<std::uint16_t>(bytes[0] | bytes[1] << 8);
  }
  std::uint8_t error_register() const noexcept { return bytes[2]; }
  bool operator==(const EmcyRecord&) const = default;
};

/// Keeps the newest EMCYs of each node. All calls come from the front thread.
class EmcyLog {
 public:
  static constexpr std::size_t depth = 32;       ///< records per node
  static constexpr std::size_t most_codes = 10;  ///< error codes per node
  using Codes = std::deque<std::uint16_t>;

  /// Ignores events of other kinds, and EMCYs of one byte, which have no error code.
  void take(const Event& event, std::int64_t utime);
  /// Returns the records of a node, oldest first.
  const std::vector<EmcyRecord>& of(std::uint8_t node) const { return node_log(node).records; }
  /// Returns the error codes of a node, newest first, without code 0, which reports that all errors
  /// are gone.
  const Codes& codes(std::uint8_t node) const { return node_log(node).codes; }

 private:
  struct NodeLog {
    std::vector<EmcyRecord> records;
    Codes codes;
  };
  const NodeLog& node_log(std::uint8_t node) const;

  std::map<std::uint8_t, NodeLog> nodes_;
};

/// Encodes records for the reply to "emcy_history": per record 8 bytes of time and the 8 bytes of
/// the frame, little endian.
std::vector<std::uint8_t> pack(std::span<const EmcyRecord> records);
std::vector<EmcyRecord> unpack_emcys(std::span<const std::uint8_t> bytes);

/// Returns the texts of the device data for these error codes, in the form of the reply text: one
/// line `0x1000 words` per code. Codes without a text are left out.
std::string pack_texts(std::span<const EmcyRecord> records, std::span<const EmcyText> texts);
std::map<std::uint16_t, std::string> unpack_texts(std::string_view lines);

}  // namespace takt
