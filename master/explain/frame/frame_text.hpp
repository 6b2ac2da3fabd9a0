#pragma once
#include <optional>
#include <span>

#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/table/device_table.hpp"
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
  /// Keeps references to the plan and to the tables of its devices, which give the names and PDOs.
  FrameText(const BusPlan& plan, std::span<const DeviceTable> devices)
      : names_{plan, devices}, sdo_{names_, plan, devices} {}
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
