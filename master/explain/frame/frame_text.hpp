#pragma once
#include <cstdint>
#include <optional>

#include "master/explain/frame/error_control_text.hpp"
#include "master/explain/frame/frame_names.hpp"
#include "master/explain/frame/meaning.hpp"
#include "master/explain/frame/sdo_channels.hpp"
#include "master/wire/frame.hpp"

namespace takt {

/// Describes the frames of one bus, one after the other. It follows transfers across frames.
class FrameText {
 public:
  FrameText() : sdo_{names_} {}
  /// Keeps a reference to the network, which gives the names and PDOs.
  explicit FrameText(const LoadedNetwork& network) : names_{network}, sdo_{names_, network} {}
  FrameText(const FrameText&) = delete;
  FrameText& operator=(const FrameText&) = delete;

  /// Describes the next frame of the bus.
  FrameMeaning meaning(const Frame& frame);

 private:
  std::optional<FrameMeaning> broadcast(const Frame& frame) const;
  FrameMeaning sync(const Frame& frame) const;
  FrameMeaning nmt(const Frame& frame) const;

  FrameNames names_;
  SdoChannels sdo_;
  ErrorControlText error_control_;
};

}  // namespace takt
