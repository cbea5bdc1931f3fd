#include "report/lab_trace.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/text.h"
#include "report/markup.h"
#include "report/svg.h"

namespace papilla::report {
namespace {

constexpr int kRecordWidth = 960, kRecordLeft = 70, kRecordRight = 940, kRecordHead = 62;
constexpr int kPanelHeight = 150, kPanelGap = 14;

// One quantity over time.
struct TracePanel {
  std::string name;
  const std::vector<double>* values;
  double scale;
};

class TracePicture {
 public:
  TracePicture(const Trace& trace, const Sliding& sliding, const TraceReading& reading)
      : trace_(trace), sliding_(sliding), reading_(reading) {}

  std::string draw(const std::string& title) {
    std::vector<TracePanel> panels{{"tangential [mN]", &trace_.tangential, 1e3},
                                   {"normal [mN]", &trace_.normal, 1e3}};
    if (!trace_.voltage.empty()) panels.push_back({"voltage [V]", &trace_.voltage, 1});
    const int height =
        kRecordHead + static_cast<int>(panels.size()) * (kPanelHeight + kPanelGap) + 30;
    std::string out = svg_sheet(kRecordWidth, height, 12);
    out += fmt::format("<text x=\"12\" y=\"22\" font-size=\"14\" font-weight=\"bold\">{}</text>\n",
                       markup_text(title));
    out += fmt::format("<text x=\"12\" y=\"42\">{}</text>\n", markup_text(legend()));
    int top = kRecordHead;
    for (const TracePanel& p : panels) {
      out += panel(p, top);
      top += kPanelHeight + kPanelGap;
    }
    out += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">time [s], {} to {}</text>\n",
                       (kRecordLeft + kRecordRight) / 2, height - 12,
                       significant(trace_.time.front(), 4), significant(trace_.time.back(), 4));
    return out + "</svg>\n";
  }

 private:
  double x(std::size_t sample) const {
    const double from = trace_.time.front(), to = trace_.time.back();
    return kRecordLeft + (kRecordRight - kRecordLeft) * (trace_.time[sample] - from) / (to - from);
  }

  // The middle of steady sliding in the record, from -1/2 to 1/2. Eq. lab.13
  double late(const Stroke& s) const {
    const std::vector<double>& t = trace_.time;
    return (t[(s.steady.begin + s.steady.end) / 2] - t.front()) / (t.back() - t.front()) - 0.5;
  }

  std::string legend() const {
    std::string out = "green: steady sliding; red lines: onsets; orange: stick-slip";
    if (reading_.off_sd > 0)
      out += fmt::format("; F_off {} mN", with_error(1e3 * reading_.off, 1e3 * reading_.off_sd));
    if (reading_.on_sd > 0)
      out += fmt::format("; F_on {} mN", with_error(1e3 * reading_.on, 1e3 * reading_.on_sd));
    return out;
  }

  std::string panel(const TracePanel& p, int top) const {
    double low = 0, high = 0;
    for (const double v : *p.values) {
      low = std::min(low, v);
      high = std::max(high, v);
    }
    if (!(high > low)) high = low + 1;
    const auto y = [&](double v) { return top + kPanelHeight * (high - v) / (high - low); };
    std::string out = marks(p, top);
    out += fmt::format(
        "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"#c8ccd2\"/>\n",
        kRecordLeft, top, kRecordRight - kRecordLeft, kPanelHeight);
    for (const double v : {low, 0.0, high})
      out += fmt::format("<text x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>\n",
                         kRecordLeft - 6, y(v) + 4, significant(p.scale * v, 3));
    out += fmt::format(
        "<text x=\"14\" y=\"{0}\" text-anchor=\"middle\" transform=\"rotate(-90 14 "
        "{0})\">{1}</text>\n",
        top + kPanelHeight / 2, markup_text(p.name));
    out += curve(p, y);
    if (p.values == &trace_.tangential) out += plateaus(y);
    return out;
  }

  // A vertical line for each column of pixels, from its lowest to its highest sample.
  template <class Y>
  std::string curve(const TracePanel& p, const Y& y) const {
    std::string path;
    std::size_t i = 0;
    while (i < trace_.size()) {
      const double column = std::floor(x(i));
      double low = (*p.values)[i], high = low;
      for (; i < trace_.size() && std::floor(x(i)) == column; ++i) {
        low = std::min(low, (*p.values)[i]);
        high = std::max(high, (*p.values)[i]);
      }
      path +=
          fmt::format("{}{:.0f} {:.1f}V{:.1f}", path.empty() ? "M" : "L", column, y(high), y(low));
    }
    return fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"#1b6ca8\" stroke-width=\"1\"/>\n",
                       path);
  }

  // What was read: the friction along each direction, about the zero of the sensor.
  template <class Y>
  std::string plateaus(const Y& y) const {
    std::string out;
    for (const Stroke& s : sliding_.strokes) {
      const double zero = reading_.zero + reading_.zero_drift * late(s);
      for (const auto& [force, sd] :
           {std::pair(reading_.off, reading_.off_sd), std::pair(reading_.on, reading_.on_sd)}) {
        if (!(sd > 0) || s.steady.size() == 0) continue;
        out += fmt::format(
            "<path d=\"M{:.1f} {:.1f}H{:.1f}\" stroke=\"#333\" "
            "stroke-dasharray=\"3 3\"/>\n",
            x(s.steady.begin), y(zero + s.direction * force), x(s.steady.end - 1));
      }
    }
    return out;
  }

  std::string marks(const TracePanel& p, int top) const {
    std::string out;
    for (const Stroke& s : sliding_.strokes) {
      if (s.steady.size() == 0) continue;
      out +=
          fmt::format("<rect x=\"{:.1f}\" y=\"{}\" width=\"{:.1f}\" height=\"{}\" fill=\"{}\"/>\n",
                      x(s.steady.begin), top, x(s.steady.end - 1) - x(s.steady.begin), kPanelHeight,
                      s.sticks() ? "#fbe2c0" : "#dff0de");
      if (p.values != &trace_.tangential) continue;
      out += fmt::format("<path d=\"M{:.1f} {}v{}\" stroke=\"#c0392b\"/>\n", x(s.onset), top,
                         kPanelHeight);
    }
    return out;
  }

  const Trace& trace_;
  const Sliding& sliding_;
  const TraceReading& reading_;
};

}  // namespace

std::string trace_svg(const Trace& trace, const Sliding& sliding, const TraceReading& reading,
                      const std::string& title) {
  return TracePicture(trace, sliding, reading).draw(title);
}

std::string decisions_svg(const Lab& lab) {
  static const std::vector<std::string> colours{"#1b6ca8", "#c0392b", "#2e8b57",
                                                "#8e5ea2", "#d98e04", "#5b6770"};
  SvgPlot plot{"What the readings have decided", "readings", "p(best)", {}, true};
  bool decided = false;
  for (const LabDesign& d : lab.designs()) {
    SvgSeries line{d.choice ? d.name : d.name + ", no longer a choice",
                   colours[plot.series.size() % colours.size()],
                   {},
                   {},
                   {},
                   {},
                   true};
    for (const JournalEntry& e : lab.entries()) {
      if (!e.decision) continue;
      const std::vector<std::string>& names = e.decision->designs;
      const auto at = std::find(names.begin(), names.end(), d.name);
      if (at == names.end()) continue;
      line.x.push_back(static_cast<double>(e.decision->readings));
      line.y.push_back(e.decision->p_designs[static_cast<std::size_t>(at - names.begin())]);
    }
    decided |= !line.x.empty();
    if (d.choice || !line.x.empty()) plot.series.push_back(std::move(line));
  }
  return decided ? svg_picture({plot}) : std::string();
}

}  // namespace papilla::report
