#include "report/surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/constants.h"
#include "base/text.h"
#include "report/json.h"

namespace papilla::report {
namespace {

using Json = nlohmann::ordered_json;
constexpr int kBins = 48;     // of the histogram
constexpr int kColumns = 72;  // of the section on a terminal

// Bars of eighths, the largest value full.
std::string bars(const std::vector<double>& values, double low) {
  constexpr std::array kBars{" ", "▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};
  const double high = *std::max_element(values.begin(), values.end());
  std::string out;
  for (const double v : values) {
    const double share = high > low ? (v - low) / (high - low) : 0;
    out += kBars[static_cast<std::size_t>(std::clamp(std::lround(8 * share), 0L, 8L))];
  }
  return out;
}

std::vector<double> middle_row(const Heightmap& h) {
  const auto row = h.z.begin() + static_cast<std::ptrdiff_t>(h.grid.index(0, h.grid.ny / 2));
  return {row, row + h.grid.nx};
}

// The mean of as many neighbours as make so many columns.
std::vector<double> columns_of(const std::vector<double>& row, int columns) {
  const auto n = static_cast<int>(row.size());
  const int wanted = std::min(n, columns);
  std::vector<double> out(static_cast<std::size_t>(wanted)), count(out.size());
  for (int i = 0; i < n; ++i) {
    const auto to = static_cast<std::size_t>(static_cast<long>(i) * wanted / n);
    out[to] += row[static_cast<std::size_t>(i)];
    count[to] += 1;
  }
  for (std::size_t i = 0; i < out.size(); ++i) out[i] /= count[i];
  return out;
}

std::string length_text(const std::optional<double>& metres, const char* otherwise) {
  return metres ? fmt::format("{:.4g} um", 1e6 * *metres) : otherwise;
}

std::string parameter_table(const ArealParameters& a) {
  const auto nm = [](double metres) { return fmt::format("{:.5g} nm", 1e9 * metres); };
  const auto plain = [](double value) { return fmt::format("{:.4g}", value); };
  const std::string limited = a.sampling_limited ? " (grows with finer pixels)" : "";
  const std::vector<std::vector<std::string>> rows{
      {"Sq", nm(a.sq), "rms height"},
      {"Sa", nm(a.sa), "mean height"},
      {"Sz", nm(a.sz), fmt::format("highest {} and lowest {} from the mean", nm(a.sp), nm(a.sv))},
      {"Ssk", plain(a.ssk), "skewness: below 0 valleys, above 0 peaks"},
      {"Sku", plain(a.sku), "kurtosis: 3 of a Gaussian"},
      {"Sdq", plain(a.sdq), "rms slope" + limited},
      {"Sdr", fmt::format("{:.4g} %", 100 * a.sdr), "area beyond the flat one" + limited},
      {"Sal", length_text(a.sal, "longer than half the map"), "autocorrelation falls to 0.2"},
      {"Str", a.str ? plain(*a.str) : "not known: alike over half the map in some direction",
       "1: the same in all directions, 0: grooves"},
      {"Std", fmt::format("{:.1f} deg", a.std * 180 / kPi), "where the spectrum is strongest"},
      {"Sk", nm(a.sk), "height of the core"},
      {"Spk", nm(a.spk), fmt::format("peaks above it, Smr1 {:.3g} %", 100 * a.smr1)},
      {"Svk", nm(a.svk), fmt::format("valleys below it, Smr2 {:.3g} %", 100 * a.smr2)},
  };
  return aligned_table(rows, 3);
}

std::string spectrum_table(const SurfaceView& view) {
  std::string out = fmt::format(
      "wavelengths that this map can know: {:.4g} um (a quarter of its shorter side) to {:.4g} nm "
      "({})\n",
      1e6 * view.band.longest, 1e9 * view.band.shortest,
      view.band.by_tip ? fmt::format("a tip of {:.3g} nm", 1e9 * view.tip) : "two pixels");
  std::vector<std::vector<std::string>> rows{{"um", "C(q) um^4", ""}};
  for (const SpectrumRing& ring : view.spectrum) {
    const bool known = ring.wavelength <= view.band.longest * (1 + 1e-9) &&
                       ring.wavelength >= view.band.shortest * (1 - 1e-9);
    rows.push_back({fmt::format("{:.4g}", 1e6 * ring.wavelength),
                    fmt::format("{:.4g}", 1e24 * ring.density), known ? "" : "beyond"});
  }
  return out + aligned_table(rows, 0);
}

Json scan_json(const std::string& file, const ScanChanges& c) {
  Json where;
  if (c.replaced > 0) where = {{"x", {c.where.x0, c.where.x1}}, {"y", {c.where.y0, c.where.y1}}};
  return {{"file", file},
          {"as_is", c.as_is},
          {"repeats", c.repeats},
          {"tilt", c.tilt()},
          {"slope", {c.slope_x, c.slope_y}},
          {"rise", c.rise},
          {"pixels", c.pixels},
          {"replaced", c.replaced},
          {"furthest", c.furthest},
          {"where", where},
          {"filled", c.filled},
          {"highest", c.highest},
          {"rms", c.rms}};
}

Json areal_json(const ArealParameters& a) {
  return {{"Sa", a.sa},
          {"Sq", a.sq},
          {"Sz", a.sz},
          {"Sp", a.sp},
          {"Sv", a.sv},
          {"Ssk", a.ssk},
          {"Sku", a.sku},
          {"Sdq", a.sdq},
          {"Sdr", a.sdr},
          {"slopes_sampling_limited", a.sampling_limited},
          {"Sal", json_number(a.sal)},
          {"Str", json_number(a.str)},
          {"Std", a.std},
          {"Sk", a.sk},
          {"Spk", a.spk},
          {"Svk", a.svk},
          {"Smr1", a.smr1},
          {"Smr2", a.smr2}};
}

}  // namespace

SurfaceView view_of(const ScanSource& source, double tip) {
  return view_of(source.file, read_scan(source), tip);
}

SurfaceView view_of(const std::string& file, Scan scan, double tip) {
  SurfaceView out{file, std::move(scan), {}, {}, {}, tip};
  out.areal = areal_parameters(out.scan.map);
  out.spectrum = radial_spectrum(out.scan.map);
  out.band = known_band(out.scan.map, out.spectrum, tip);
  return out;
}

std::string surface_text(const SurfaceView& view) {
  const Heightmap& h = view.scan.map;
  const Grid& g = h.grid;
  const auto [low, high] = std::minmax_element(h.z.begin(), h.z.end());
  const std::vector<double> section = middle_row(h);
  const auto [least, most] = std::minmax_element(section.begin(), section.end());
  return text(view.file, view.scan.changes) +
         fmt::format("\n{:.6g} x {:.6g} um, {} x {} pixels of {:.4g} x {:.4g} nm\n\n", 1e6 * g.lx,
                     1e6 * g.ly, g.nx, g.ny, 1e9 * g.dx(), 1e9 * g.dy()) +
         parameter_table(view.areal) + '\n' + spectrum_table(view) +
         fmt::format("\nheights from {:.4g} to {:.4g} nm\n{}\n", 1e9 * *low, 1e9 * *high,
                     bars(height_histogram(h, kBins), 0)) +
         fmt::format("\nsection along x at y = {:.4g} um, {:.4g} to {:.4g} nm\n{}\n",
                     1e6 * g.y(g.ny / 2), 1e9 * *least, 1e9 * *most,
                     bars(columns_of(section, kColumns), *least));
}

std::string surface_json(const SurfaceView& view) {
  const Heightmap& h = view.scan.map;
  const Grid& g = h.grid;
  const auto [low, high] = std::minmax_element(h.z.begin(), h.z.end());
  Json spectrum = Json::array();
  for (const SpectrumRing& ring : view.spectrum)
    spectrum.push_back({{"wavelength", ring.wavelength}, {"density", ring.density}});
  return Json{
      {"schema", 1},
      {"scan", scan_json(view.file, view.scan.changes)},
      {"size", {g.lx, g.ly}},
      {"pixels", {g.nx, g.ny}},
      {"areal", areal_json(view.areal)},
      {"band",
       {{"longest", view.band.longest},
        {"shortest", view.band.shortest},
        {"by_tip", view.band.by_tip}}},
      {"spectrum", spectrum},
      {"histogram", {{"lowest", *low}, {"highest", *high}, {"shares", height_histogram(h, kBins)}}},
      {"section", {{"y", g.y(g.ny / 2)}, {"heights", middle_row(h)}}}}
      .dump(2);
}

std::string with_scan(const std::string& document, const std::string& file,
                      const ScanChanges& changes) {
  Json out = Json::parse(document);
  out["scan"] = scan_json(file, changes);
  return out.dump(2);
}

}  // namespace papilla::report
