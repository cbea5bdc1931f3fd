// The dose of each pixel by a curve over depth.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/files.h"
#include "config/columns.h"
#include "geometry/io/layout.h"

namespace papilla::geometry {

namespace {

// Which of the two columns is which, and the unit of the depths [m]: without a heading, or where it
// names none, nanometres.
struct DoseColumns {
  bool grey_first = false;
  double unit = 1e-9;
};

// Throws InputError.
DoseColumns read_dose_heading(std::string_view line, const std::string& place) {
  static const std::vector<ColumnKind> kinds{
      {"depth", "nm"}, {"depth", ""}, {"grey", "", false, {"gray"}}};
  std::vector<std::string_view> cells;
  split_cells(line, ',', cells);
  const Header found = read_header(cells, kinds);
  if (!found.problems.empty()) throw InputError(place + ": " + found.problems.front().second);
  const bool grey_first = !found.columns.empty() && found.columns.front().kind == &kinds.back();
  const TableColumn* depth =
      found.columns.size() == 2 ? &found.columns[grey_first ? 1 : 0] : nullptr;
  if (!depth || !depth->kind || depth->kind == &kinds.back() || !found.has(kinds.back()))
    throw InputError(fmt::format(
        "{}: \"{}\" names no columns: expected depth_nm,grey, the depth in any unit", place, line));
  return {grey_first, depth->kind->unit.empty() ? DoseColumns{}.unit : depth->to_si};
}

}  // namespace

DoseCurve read_dose_curve(const std::string& path) {
  const std::string text = read_bytes(path, 1 << 20);
  Lines lines(text);
  DoseCurve out;
  DoseColumns columns;
  bool heading = false;
  for (std::string_view line; lines.next(line);) {
    if (line.empty() || line.front() == '#') continue;
    const std::string place = fmt::format("{}:{}", path, lines.number());
    double depth = 0, grey = 0;
    char rest = 0;
    if (std::sscanf(std::string(line).c_str(), "%lf , %lf %c", &depth, &grey, &rest) != 2) {
      const bool other_separator = line.find_first_of(";\t") != std::string::npos;
      if (!std::exchange(heading, true) && out.depth.empty() && !other_separator) {
        columns = read_dose_heading(line, place);
        continue;
      }
      throw InputError(
          fmt::format("{}: expected depth_nm,grey{}", place,
                      other_separator ? "; the separator is a comma, decimals a point" : ""));
    }
    if (columns.grey_first) std::swap(depth, grey);
    depth *= columns.unit;
    if (!(grey >= 0 && grey <= 255) || !(depth >= 0 && depth < 1))
      throw InputError(fmt::format("{}: expected a depth from 0 and a grey of 0 to 255", place));
    out.depth.push_back(depth);
    out.grey.push_back(grey);
  }
  if (out.depth.size() < 2) throw InputError(path + ": expected at least two lines depth_nm,grey");
  if (out.depth.front() > out.depth.back()) {
    std::reverse(out.depth.begin(), out.depth.end());
    std::reverse(out.grey.begin(), out.grey.end());
  }
  const bool rising = out.grey.back() > out.grey.front();
  for (std::size_t i = 1; i < out.depth.size(); ++i) {
    const bool grey_moves = rising ? out.grey[i] > out.grey[i - 1] : out.grey[i] < out.grey[i - 1];
    if (out.depth[i] <= out.depth[i - 1] || !grey_moves) {
      throw InputError(fmt::format("{}: depth over grey is not monotone at {:.4g} nm, grey {:.4g}",
                                   path, 1e9 * out.depth[i], out.grey[i]));
    }
  }
  return out;
}

std::vector<std::uint8_t> dose_levels(const Heightmap& h, const DoseCurve& curve, DoseMap& out) {
  const double high = *std::max_element(h.z.begin(), h.z.end());
  std::vector<std::uint8_t> grey(h.z.size());
  const auto& d = curve.depth;
  for (int iy = 0; iy < h.grid.ny; ++iy) {
    for (int ix = 0; ix < h.grid.nx; ++ix) {
      const double depth = high - h(ix, iy);
      double value = curve.grey.front();
      if (depth < d.front() - 0.5e-9) {
        ++out.shallow;
      } else if (depth > d.back() + 0.5e-9) {
        ++out.deep;
        value = curve.grey.back();
      } else if (depth > d.front()) {
        const auto i = static_cast<std::size_t>(
            std::min(std::upper_bound(d.begin(), d.end(), depth), d.end() - 1) - d.begin());
        const double share = std::min(1.0, (depth - d[i - 1]) / (d[i] - d[i - 1]));
        value = curve.grey[i - 1] + share * (curve.grey[i] - curve.grey[i - 1]);
      }
      grey[h.grid.index(ix, h.grid.ny - 1 - iy)] =
          static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
    }
  }
  const auto [a, b] = std::minmax_element(grey.begin(), grey.end());
  out.lowest = *a, out.highest = *b;
  return grey;
}

}  // namespace papilla::geometry
