#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace takt {

/// The width of the line of a curve.
enum class Stroke : std::uint8_t { thin, broad };

/// One curve of a panel: a value for each time of the plot. NaN leaves a gap.
struct Curve {
  std::vector<double> values = {};
  std::size_t colour = 0;  ///< number of the colour; the same for all curves of an axis
  Stroke stroke = Stroke::thin;
};

/// Curves of one quantity over the time. The name of a panel that is less than 60 pixels high is
/// written above the panel.
struct Panel {
  std::string quantity = {};  ///< "position"
  std::string unit = {};      ///< "rad"
  std::vector<Curve> curves = {};
  double height = 130.0;  ///< pixels
};

/// An entry of the legend, which describes all curves of this colour and stroke.
struct LegendEntry {
  std::string text = {};
  std::size_t colour = 0;
  Stroke stroke = Stroke::thin;
};

/// A picture with panels one below the other. All curves have the same times.
struct Plot {
  std::string title = {};
  std::vector<LegendEntry> legend = {};
  std::vector<double> times = {};  ///< s, in ascending order
  std::vector<Panel> panels = {};
  std::string note = {};  ///< a line below the panels; may be empty
};

/// Returns the picture as an SVG document without scripts, for light and dark pages. The texts are
/// UTF-8; they are escaped, and control characters are replaced.
std::string plot_svg(const Plot& plot);

}  // namespace takt
