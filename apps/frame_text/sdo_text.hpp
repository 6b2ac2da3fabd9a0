#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "apps/frame_text/block_text.hpp"
#include "apps/frame_text/names.hpp"
#include "master/wire/frame.hpp"

namespace takt {

/// SDO frames of one channel in words. Follows the transfer, so that segments name their object,
/// the last one shows the value, and a repeated toggle bit or a wrong length is told. CiA
/// 301, 7.2.4.3.
class SdoText {
 public:
  /// `node`: the server.
  SdoText(const FrameNames& names, unsigned node) : names_{&names}, node_{node} {}

  std::string request(const Frame& frame);
  std::string answer(const Frame& frame);

 private:
  struct Transfer {
    ObjectKey object;
    bool open = false;       // segments follow
    bool truncated = false;  // longer than what is kept
    std::optional<std::uint32_t> announced{};
    std::optional<bool> asked_toggle{};     // of the client's newest segment frame
    std::optional<bool> answered_toggle{};  // of the server's
    std::size_t length = 0;                 // bytes that were in segments so far
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
