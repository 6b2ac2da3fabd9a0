#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "master/explain/frame/block_text.hpp"
#include "master/explain/frame/frame_names.hpp"
#include "master/wire/frame.hpp"

namespace takt {

/// Describes the SDO frames of one channel. It follows the transfer, so that segments name their
/// object, the last segment shows the value, and a repeated toggle bit or a wrong length is
/// reported. CiA 301, 7.2.4.3.
class SdoText {
 public:
  /// `node` is the node-ID of the SDO server.
  SdoText(const FrameNames& names, unsigned node) : names_{&names}, node_{node} {}

  /// Describes a frame of the client.
  std::string request(const Frame& frame);
  /// Describes a frame of the server.
  std::string answer(const Frame& frame);

 private:
  struct Transfer {
    ObjectKey object;
    bool open = false;       // true if segments follow
    bool truncated = false;  // true if the value is longer than the part that is kept
    std::optional<std::uint32_t> announced{};
    std::optional<bool> asked_toggle{};     // toggle bit of the client's newest segment frame
    std::optional<bool> answered_toggle{};  // toggle bit of the server's newest segment frame
    std::size_t length = 0;                 // number of bytes in all segments so far
    std::vector<std::uint8_t> value{};
  };

  std::string object() const;
  std::string value(ObjectKey key, std::span<const std::uint8_t> bytes) const;
  std::string initiate(const Frame& frame, const char* verb);
  std::string segment(const Frame& frame, std::string_view toggled, const char* verb);
  std::string abort(const Frame& frame);
  std::string block(BlockText::Direction data_go, const Frame& frame);
  void lose_block() noexcept;
  bool begins_block(const Frame& frame);
  void keep(std::span<const std::uint8_t> bytes);
  static std::string_view toggle_text(std::optional<bool>& last, const Frame& frame);

  const FrameNames* names_;
  unsigned node_;
  Transfer transfer_{};
  BlockText block_{};
};

}  // namespace takt
