#pragma once
#include <string>
#include <vector>

namespace takt {

/// A point of a picture, in pixels.
struct PlotPoint {
  double x = 0.0;
  double y = 0.0;
};

/// Returns the attribute `d` of an SVG path along these points, which are in ascending order of x.
/// Of the points in one column of two pixels, only the lowest and the highest remain, and points on
/// a straight line are left out, so that the text stays short. A y of NaN leaves a gap.
std::string path_along(const std::vector<PlotPoint>& points);

}  // namespace takt
