#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "apps/frame_text/names.hpp"
#include "master/wire/frame.hpp"

namespace takt {

/// SDO frames in words. Follows the transfer of each node, so that segments name their object and
/// the last one shows the value. CiA 301, 7.2.4.3.
class SdoText {
 public:
  explicit SdoText(const FrameNames& names) : names_{&names} {}

  std::string request(unsigned node, const Frame& frame);
  std::string answer(unsigned node, const Frame& frame);

 private:
  struct Transfer {
    ObjectKey object;
    bool open = false;   // segments follow
    bool block = false;  // segments are those of a block transfer
    bool upload = false;
    bool truncated = false;  // longer than what is kept
    std::vector<std::uint8_t> value;
  };

  std::string object(unsigned node, const Transfer& transfer) const;
  std::string initiate(unsigned node, Transfer& transfer, const Frame& frame, const char* verb);
  std::string segment(unsigned node, Transfer& transfer, const Frame& frame, const char* verb);
  std::string block_segment(unsigned node, Transfer& transfer, const Frame& frame);
  std::string abort(unsigned node, Transfer& transfer, const Frame& frame);
  std::string block_request(unsigned node, Transfer& transfer, const Frame& frame);
  std::string block_answer(unsigned node, Transfer& transfer, const Frame& frame);
  static void keep(Transfer& transfer, std::span<const std::uint8_t> bytes);

  const FrameNames* names_;
  std::array<Transfer, 128> transfers_{};
};

}  // namespace takt
