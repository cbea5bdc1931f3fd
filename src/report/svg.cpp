#include "report/svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/markup.h"

namespace papilla::report {
namespace {

constexpr double kPlotWidth = 460, kPlotHeight = 380, kPlotLeft = 64, kPlotRight = 444,
                 kPlotTop = 76, kPlotBottom = 330;

double at(const std::vector<double>& values, std::size_t i) {
  return i < values.size() ? values[i] : 0;
}

// A linear axis over the values with round ticks.
struct Axis {
  double low = 0, high = 1, step = 0.2;

  Axis(double from, double to) {
    if (!(from < to)) {  // one value, or none
      const double middle = std::isfinite(from) ? from : 0;
      from = middle - std::max(0.5 * std::abs(middle), 0.5);
      to = middle + std::max(0.5 * std::abs(middle), 0.5);
    }
    const double power = std::pow(10, std::floor(std::log10((to - from) / 4)));
    const double share = (to - from) / 4 / power;
    step = power * (share > 5 ? 10 : share > 2 ? 5 : share > 1 ? 2 : 1);
    low = step * std::floor(from / step + 1e-9);
    high = step * std::ceil(to / step - 1e-9);
  }
  int ticks() const { return static_cast<int>(std::lround((high - low) / step)); }
  double share(double v) const { return (v - low) / (high - low); }
};

bool drawable(const SvgSeries& s, std::size_t i) {
  return std::isfinite(s.x[i]) && std::isfinite(s.y[i]);
}

Axis axis_of(const SvgPlot& plot, bool y) {
  double low = y && plot.from_zero ? 0 : INFINITY, high = -INFINITY;
  for (const SvgSeries& s : plot.series) {
    for (std::size_t i = 0; i < s.x.size(); ++i) {
      if (!drawable(s, i)) continue;
      const double v = y ? s.y[i] : s.x[i], e = at(y ? s.ey : s.ex, i);
      low = std::min(low, v - e);
      high = std::max(high, v + e);
    }
  }
  return {low, high};
}

// Where numbers are in the picture.
struct Frame {
  Axis x, y;
  double shift;  // of the plot to the right [px]

  double px(double v) const { return shift + kPlotLeft + (kPlotRight - kPlotLeft) * x.share(v); }
  double py(double v) const { return kPlotBottom - (kPlotBottom - kPlotTop) * y.share(v); }
};

std::string draw_axes(const SvgPlot& plot, const Frame& f) {
  const Axis &ax = f.x, &ay = f.y;
  std::string out;
  for (int i = 0; i <= ax.ticks(); ++i) {
    const double v = ax.low + i * ax.step;
    out += fmt::format(
        "<line x1=\"{0:.1f}\" y1=\"{1}\" x2=\"{0:.1f}\" y2=\"{2}\" stroke=\"#e3e6ea\"/>"
        "<text x=\"{0:.1f}\" y=\"{3}\" text-anchor=\"middle\">{4:.4g}</text>\n",
        f.px(v), kPlotTop, kPlotBottom, kPlotBottom + 16, std::abs(v) < 1e-9 * ax.step ? 0 : v);
  }
  for (int i = 0; i <= ay.ticks(); ++i) {
    const double v = ay.low + i * ay.step;
    out += fmt::format(
        "<line x1=\"{0:.0f}\" y1=\"{2:.1f}\" x2=\"{1:.0f}\" y2=\"{2:.1f}\" stroke=\"#e3e6ea\"/>"
        "<text x=\"{3:.0f}\" y=\"{4:.1f}\" text-anchor=\"end\">{5:.4g}</text>\n",
        f.shift + kPlotLeft, f.shift + kPlotRight, f.py(v), f.shift + kPlotLeft - 6, f.py(v) + 4,
        std::abs(v) < 1e-9 * ay.step ? 0 : v);
  }
  out += fmt::format("<text x=\"{:.0f}\" y=\"{:.0f}\" text-anchor=\"middle\">{}</text>\n",
                     f.shift + (kPlotLeft + kPlotRight) / 2, kPlotBottom + 38, markup_text(plot.x));
  out += fmt::format(
      "<text x=\"{0:.0f}\" y=\"{1:.0f}\" text-anchor=\"middle\" transform=\"rotate(-90 {0:.0f} "
      "{1:.0f})\">{2}</text>\n",
      f.shift + 16, (kPlotTop + kPlotBottom) / 2, markup_text(plot.y));
  return out;
}

std::string draw_series(const SvgSeries& s, const Frame& f) {
  std::string out;
  std::string line, upper, lower, marks;
  for (std::size_t i = 0; i < s.x.size(); ++i) {
    if (!drawable(s, i)) continue;
    const double x = f.px(s.x[i]), y = f.py(s.y[i]), ex = at(s.ex, i), ey = at(s.ey, i);
    line += fmt::format("{:.1f},{:.1f} ", x, y);
    if (s.band) {
      upper += fmt::format("{:.1f},{:.1f} ", x, f.py(s.y[i] + ey));
      lower = fmt::format("{:.1f},{:.1f} ", x, f.py(s.y[i] - ey)) + lower;
    } else {
      if (ex > 0)
        marks += fmt::format("<path d=\"M{:.1f} {:.1f}H{:.1f}\"/>", f.px(s.x[i] - ex), y,
                             f.px(s.x[i] + ex));
      if (ey > 0)
        marks += fmt::format("<path d=\"M{:.1f} {:.1f}V{:.1f}\"/>", x, f.py(s.y[i] - ey),
                             f.py(s.y[i] + ey));
    }
    marks += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\"/>", x, y, s.radius);
  }
  if (s.band)
    out += fmt::format("<polygon fill=\"{}\" fill-opacity=\"0.15\" points=\"{}{}\"/>\n", s.colour,
                       upper, lower);
  if (s.line)
    out +=
        fmt::format("<polyline fill=\"none\" stroke=\"{}\" stroke-width=\"1.8\" points=\"{}\"/>\n",
                    s.colour, line);
  out += fmt::format("<g fill=\"{0}\" stroke=\"{0}\">{1}</g>\n", s.colour, marks);
  return out;
}

std::string draw_plot(const SvgPlot& plot, double shift) {
  const Frame frame{axis_of(plot, false), axis_of(plot, true), shift};
  std::string out =
      fmt::format("<text x=\"{:.0f}\" y=\"22\" font-size=\"14\" font-weight=\"bold\">{}</text>\n",
                  shift + 12, markup_text(plot.title));
  out += draw_axes(plot, frame);
  double legend = kPlotLeft;
  for (const SvgSeries& s : plot.series) {
    out += draw_series(s, frame);
    if (s.name.empty()) continue;
    out += fmt::format(
        "<circle cx=\"{:.0f}\" cy=\"50\" r=\"4\" fill=\"{}\"/><text x=\"{:.0f}\" y=\"54\">{}"
        "</text>\n",
        shift + legend, s.colour, shift + legend + 9, markup_text(s.name));
    legend += 26 + 6.6 * static_cast<double>(s.name.size());
  }
  return out;
}

}  // namespace

std::string svg_sheet(int width, int height, int font_size) {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" "
      "font-family=\"sans-serif\" font-size=\"{2}\">\n<rect width=\"{0}\" height=\"{1}\" "
      "fill=\"white\"/>\n",
      width, height, font_size);
}

std::string svg_picture(const std::vector<SvgPlot>& plots) {
  const double width = kPlotWidth * static_cast<double>(plots.size());
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" "
      "height=\"{1:.0f}\" font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"{0:.0f}\" "
      "height=\"{1:.0f}\" fill=\"white\"/>\n",
      width, kPlotHeight);
  for (std::size_t i = 0; i < plots.size(); ++i)
    out += draw_plot(plots[i], kPlotWidth * static_cast<double>(i));
  return out + "</svg>\n";
}

}  // namespace papilla::report
