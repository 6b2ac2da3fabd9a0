#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "master/explain/frame/frame_names.hpp"
#include "master/trace/sdo_follower.hpp"
#include "master/wire/frame.hpp"

namespace takt {

/// Describes the SDO frames of one channel. It follows the transfers, so that segments name their
/// object, the last segment shows the value, and a repeated toggle bit, a wrong length or a wrong
/// CRC is reported. CiA 301, 7.2.4.3.
class SdoText {
 public:
  /// `node` is the node-ID of the SDO server.
  SdoText(const FrameNames& names, unsigned node) : names_{&names}, node_{node} {}

  /// Describes a frame of the client.
  std::string request(const Frame& frame);
  /// Describes a frame of the server.
  std::string answer(const Frame& frame);

 private:
  std::string object() const;
  std::string value(ObjectKey key, std::span<const std::uint8_t> bytes) const;
  std::string initiate(const Frame& frame, const char* verb) const;
  std::string segment(const Frame& frame, const char* verb) const;
  std::string abort(const Frame& frame) const;
  std::string_view toggle_text() const noexcept;

  std::string block(BlockFollower::Part part, const Frame& frame) const;
  std::string block_accept(const Frame& frame, const std::string& name) const;
  std::string block_confirm(const Frame& frame) const;
  std::string block_end(const Frame& frame, const std::string& name) const;
  const char* block_verb() const noexcept {
    return follower_.block().uploads() ? "block upload" : "block download";
  }

  const FrameNames* names_;
  unsigned node_;
  SdoFollower follower_;
};

}  // namespace takt
