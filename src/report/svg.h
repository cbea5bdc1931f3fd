// Line and point plots as SVG, for pictures that live beside text: results folders, the gallery.
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"

namespace papilla::report {

struct SvgSeries {
  std::string name;            // in the legend; empty: not there
  std::string colour;          // "#1b6ca8"
  std::vector<double> x, y;    // as the axes say
  std::vector<double> ex, ey;  // half lengths of error bars; empty: none
  bool line = false;
  bool band = false;  // ey as a filled band in place of bars
  double radius = 3.5;
};

struct SvgPlot {
  std::string title, x, y;  // x, y: axis titles with their units
  std::vector<SvgSeries> series;
  bool from_zero = false;  // the y axis begins at 0
};

// The opening element of a picture and its white ground.
std::string svg_sheet(int width, int height, int font_size);

// The plots side by side, 460 x 380 each. Values that are not finite are left out.
std::string svg_picture(const std::vector<SvgPlot>& plots);

}  // namespace papilla::report
