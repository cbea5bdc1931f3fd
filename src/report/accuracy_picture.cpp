// The log-log picture of a sweep.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "report/accuracy.h"
#include "report/svg.h"

namespace papilla::report {
namespace {

constexpr const char* kColours[] = {"#1b6ca8", "#d1495b", "#555555",
                                    "#3c8d5a", "#8a5fbf", "#c98a1b"};
constexpr double kLeft = 70, kRight = 470, kTop = 40, kBottom = 360;  // of the plot [px]

// Whole decades that hold some positive numbers.
struct Decades {
  double low = kInfinity, high = 0;

  void add(double v) {
    low = std::min(low, v);
    high = std::max(high, v);
  }
  bool empty() const { return !(low < high); }
  double first() const { return std::floor(std::log10(low)); }
  double last() const { return std::ceil(std::log10(high)); }
  // Place of a number along an axis of this length.
  double place(double v, double length) const {
    return length * (std::log10(v) - first()) / (last() - first());
  }
};

bool is_drawn(double error) { return std::isfinite(error) && error != 0; }

}  // namespace

std::string accuracy_svg(const std::vector<AccuracyRow>& all, const std::string& sweep) {
  std::vector<const AccuracyRow*> rows;
  Decades work, errors;
  for (const AccuracyRow& row : all) {
    if (row.sweep != sweep) continue;
    rows.push_back(&row);
    work.add(row.work);
    for (double e : row.error) {
      if (is_drawn(e)) errors.add(std::abs(e));
    }
  }
  std::string out = svg_sheet(640, 420, 12);
  if (work.empty() || errors.empty()) return out + "</svg>\n";
  const auto px = [&](double x) { return kLeft + work.place(x, kRight - kLeft); };
  const auto py = [&](double y) { return kBottom - errors.place(y, kBottom - kTop); };
  for (double d = work.first(); d <= work.last(); ++d) {
    out += fmt::format(
        "<line x1=\"{0:.1f}\" y1=\"40\" x2=\"{0:.1f}\" y2=\"360\" stroke=\"#ddd\"/>"
        "<text x=\"{0:.1f}\" y=\"376\" text-anchor=\"middle\">1e{1:.0f}</text>\n",
        px(std::pow(10, d)), d);
  }
  for (double d = errors.first(); d <= errors.last(); ++d) {
    out += fmt::format(
        "<line x1=\"70\" y1=\"{0:.1f}\" x2=\"470\" y2=\"{0:.1f}\" stroke=\"#ddd\"/>"
        "<text x=\"62\" y=\"{0:.1f}\" text-anchor=\"end\">1e{1:.0f}</text>\n",
        py(std::pow(10, d)), d);
  }
  out += fmt::format(
      "<text x=\"70\" y=\"24\" font-size=\"14\">{}: relative error against work"
      "</text><text x=\"270\" y=\"400\" text-anchor=\"middle\">FFT pairs of 256 x "
      "256</text>\n",
      sweep);
  for (std::size_t q = 0; q < accuracy_quantities().size(); ++q) {
    std::string points;
    for (const AccuracyRow* r : rows) {
      if (!is_drawn(r->error[q])) continue;
      const double x = px(r->work), y = py(std::abs(r->error[q]));
      points += fmt::format("{:.1f},{:.1f} ", x, y);
      out += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\" fill=\"{}\"/>\n", x, y,
                         kColours[q]);
    }
    out += fmt::format(
        "<polyline fill=\"none\" stroke=\"{0}\" stroke-width=\"1.5\" points=\"{1}\"/>"
        "<text x=\"484\" y=\"{2}\" fill=\"{0}\">{3}</text>\n",
        kColours[q], points, 60 + 20 * q, accuracy_quantities()[q].name);
  }
  return out + "</svg>\n";
}

}  // namespace papilla::report
