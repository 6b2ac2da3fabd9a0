#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "apps/takt/smooth/judge/smooth_verdict.hpp"

namespace takt::smooth {

/// A recording to generate: CiA 402 drives in csp, moved there and back on smooth paths.
struct Recipe {
  Time period = std::chrono::milliseconds{2};
  unsigned axes = 1;
  std::uint32_t seed = 1;
  bool boot = true;               ///< the recording has the SDO transfers of the boot
  double noise = 0.03;            ///< of the times of set-points, as a share of the period
  double sync_noise = 0.01;       ///< of SYNC, likewise
  double phase = 0.55;            ///< when set-points are sent after SYNC, likewise
  double delay_cycles = 1;        ///< time constant of the drive
  std::uint8_t transmission = 1;  ///< of the RPDO
  double interpolation = 1;       ///< 60C2 in periods; 0 = it is not written
  double size = 1;                ///< of the motions
  bool position_shown = true;     ///< 6064 is mapped; otherwise only 606C is
  std::uint32_t bitrate = 0;      ///< bit/s, if it is known
};

/// A set-point on the wire.
struct Sent {
  Time when{};
  double value = 0;
};

/// The actions of an axis and of its sender, from which the frames are made.
struct GeneratedAxis {
  std::function<double(Time)> path;   ///< position at a time, increments
  std::vector<Sent> sent;             ///< one for each cycle, until a defect changes it
  std::vector<std::uint16_t> status;  ///< of each cycle
  std::vector<std::int8_t> mode;      ///< of each cycle
  std::function<double(Time)> shake;  ///< added to the actual position; may be empty
};

/// A recording before its frames are made. A defect changes it.
struct Generated {
  Recipe recipe;
  std::mt19937 random;
  std::vector<Time> syncs;  ///< of each cycle
  std::vector<GeneratedAxis> axes;
  std::vector<Sample> others;  ///< times of other frames with eight bytes

  /// Returns the time of SYNC number k as it is planned.
  Time planned(std::size_t k) const;
  /// Returns true with this probability.
  bool chance(double probability);
  double normal(double deviation);
};

using Defect = std::function<void(Generated&)>;

/// Makes the plan of a recording without defects.
Generated generated(const Recipe& recipe);

/// Applies the defect, makes frames of the recording, reads them as `takt smooth` does, and judges.
Verdict verdict_of(const Recipe& recipe, const Defect& defect = {});

/// Returns all findings, for the message of a test that fails.
std::string findings_text(const Verdict& verdict);

}  // namespace takt::smooth
