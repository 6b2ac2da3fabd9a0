#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "apps/frame_text/names.hpp"
#include "apps/frame_text/sdo_text.hpp"
#include "master/wire/frame.hpp"

namespace takt {

/// What a frame means to CANopen.
struct FrameMeaning {
  std::string_view service = "?";  ///< "NMT", "SYNC", "EMCY", "TIME", "TPDO", "RPDO", "SDO", ...
  unsigned node = 0;               ///< 0: none, or all
  std::string text{};              ///< after the service: "shoulder operational"
};

/// Reads frames one after the other, of one bus.
class FrameText {
 public:
  FrameText() : sdo_{names_} {}
  explicit FrameText(const LoadedNetwork& network) : names_{network}, sdo_{names_} {}
  FrameText(const FrameText&) = delete;
  FrameText& operator=(const FrameText&) = delete;

  FrameMeaning meaning(const Frame& frame);

 private:
  std::optional<FrameMeaning> pdo(const Frame& frame) const;
  FrameMeaning pdo_of_row(const PdoRow& row, bool tpdo, const Frame& frame) const;
  FrameMeaning predefined_pdo(const Frame& frame) const;
  FrameMeaning nmt(const Frame& frame) const;
  FrameMeaning error_control(const Frame& frame) const;
  FrameMeaning emcy(const Frame& frame) const;

  FrameNames names_;
  SdoText sdo_;
};

}  // namespace takt
