// The log-log picture of a sweep.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

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

struct Mark {
  double cost, error;
};

// The marks that no cheaper one beats, by rising cost.
std::vector<Mark> cost_front(std::vector<Mark> marks) {
  std::sort(marks.begin(), marks.end(), [](const Mark& a, const Mark& b) {
    return std::pair(a.cost, a.error) < std::pair(b.cost, b.error);
  });
  std::vector<Mark> front;
  for (const Mark& mark : marks) {
    if (front.empty() || mark.error < front.back().error) front.push_back(mark);
  }
  return front;
}

}  // namespace

std::string accuracy_svg(const std::vector<AccuracyRow>& all, const std::string& sweep) {
  const bool of_cost = sweep == "cost";
  std::vector<const AccuracyRow*> rows;
  Decades costs, errors;
  const auto cost = [&](const AccuracyRow& row) { return of_cost ? row.seconds : row.work; };
  for (const AccuracyRow& row : all) {
    if (row.sweep != sweep) continue;
    rows.push_back(&row);
    costs.add(cost(row));
    for (double e : row.error) {
      if (is_drawn(e)) errors.add(std::abs(e));
    }
  }
  std::string out = svg_sheet(640, 420, 12);
  if (costs.empty() || errors.empty()) return out + "</svg>\n";
  const auto px = [&](double x) { return kLeft + costs.place(x, kRight - kLeft); };
  const auto py = [&](double y) { return kBottom - errors.place(y, kBottom - kTop); };
  for (double d = costs.first(); d <= costs.last(); ++d) {
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
      "<text x=\"70\" y=\"24\" font-size=\"14\">{}: relative error against {}"
      "</text><text x=\"270\" y=\"400\" text-anchor=\"middle\">{}</text>\n",
      sweep, of_cost ? "time" : "work", of_cost ? "processor time [s]" : "FFT pairs of 256 x 256");
  for (std::size_t q = 0; q < accuracy_quantities().size(); ++q) {
    std::vector<Mark> marks;
    for (const AccuracyRow* r : rows) {
      if (is_drawn(r->error[q])) marks.push_back({cost(*r), std::abs(r->error[q])});
    }
    for (const Mark& mark : marks)
      out += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\" fill=\"{}\"/>\n",
                         px(mark.cost), py(mark.error), of_cost ? "2" : "3.5", kColours[q]);
    std::string points;
    for (const Mark& mark : of_cost ? cost_front(marks) : marks)
      points += fmt::format("{:.1f},{:.1f} ", px(mark.cost), py(mark.error));
    out += fmt::format(
        "<polyline fill=\"none\" stroke=\"{0}\" stroke-width=\"1.5\" points=\"{1}\"/>"
        "<text x=\"484\" y=\"{2}\" fill=\"{0}\">{3}</text>\n",
        kColours[q], points, 60 + 20 * q, accuracy_quantities()[q].name);
  }
  return out + "</svg>\n";
}

}  // namespace papilla::report
