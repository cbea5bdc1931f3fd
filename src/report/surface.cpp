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

bool knows_any(const KnownBand& band) { return band.longest >= band.shortest * (1 - 1e-9); }

std::string spectrum_table(const SurfaceView& view) {
  std::string out = fmt::format(
      "wavelengths that this map can know: {}{:.4g} um (a quarter of its shorter side) {} "
      "{:.4g} nm ({})\n",
      knows_any(view.band) ? "" : "none, ", 1e6 * view.band.longest,
      knows_any(view.band) ? "to" : "is less than", 1e9 * view.band.shortest,
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
  return {{"file", file},           {"as_is", c.as_is},     {"repeats", c.repeats},
          {"made", c.made},         {"tilt", c.tilt()},     {"slope", {c.slope_x, c.slope_y}},
          {"rise", c.rise},         {"pixels", c.pixels},   {"replaced", c.replaced},
          {"furthest", c.furthest}, {"where", where},       {"filled", c.filled},
          {"marked", c.marked},     {"highest", c.highest}, {"rms", c.rms}};
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

SurfacesView joint_view(std::vector<SurfaceView> maps) {
  SurfacesView out{std::move(maps), {}, 0};
  std::vector<MapSpectrum> spectra;
  for (const SurfaceView& view : out.maps)
    spectra.push_back({line_spectrum(view.scan.map), view.band});
  out.joint = joint_spectrum(spectra);
  out.rms = joint_rms(out.joint);
  return out;
}

std::string surfaces_text(const SurfacesView& view) {
  std::string out;
  for (const SurfaceView& map : view.maps) out += text(map.file, map.scan.changes) + '\n';
  std::vector<std::vector<std::string>> rows{
      {"map", "um wide", "pixel nm", "Sa nm", "Sq nm", "Sdq", "knows um", "to nm", "ended by"}};
  for (const SurfaceView& map : view.maps) {
    const Grid& g = map.scan.map.grid;
    rows.push_back({map.file, fmt::format("{:.4g}", 1e6 * g.lx),
                    fmt::format("{:.4g}", 1e9 * g.dx()), fmt::format("{:.4g}", 1e9 * map.areal.sa),
                    fmt::format("{:.4g}", 1e9 * map.areal.sq), fmt::format("{:.3g}", map.areal.sdq),
                    knows_any(map.band) ? fmt::format("{:.4g}", 1e6 * map.band.longest) : "nothing",
                    knows_any(map.band) ? fmt::format("{:.4g}", 1e9 * map.band.shortest) : "-",
                    map.band.by_tip ? "tip" : "pixels"});
  }
  out += '\n' + aligned_table(rows, 1);
  if (view.joint.empty()) return out + "\nno wavelength is known by any of the maps\n";
  out += fmt::format(
      "\nspectrum along a line, of the maps that know a wavelength; x/: a standard deviation "
      "between "
      "them; STC: medians of the\nSurface-Topography Challenge's smoother and rougher surface "
      "(Pradhan et al. 2025). rms from {:.4g} um to {:.4g} nm: {:.4g} nm\n",
      1e6 * view.joint.front().wavelength, 1e9 * view.joint.back().wavelength, 1e9 * view.rms);
  std::vector<std::vector<std::string>> lines{
      {"um", "maps", "C(q) m^3", "x/", "STC smoother", "STC rougher"}};
  const auto consensus = [](double v) { return v > 0 ? fmt::format("{:.2e}", v) : "-"; };
  for (const JointRing& ring : view.joint) {
    const Consensus c = consensus_at(ring.wavelength);
    lines.push_back({fmt::format("{:.4g}", 1e6 * ring.wavelength), fmt::format("{}", ring.maps),
                     fmt::format("{:.3e}", ring.density),
                     ring.maps > 1 ? fmt::format("{:.2f}", ring.scatter) : "-",
                     consensus(c.smoother), consensus(c.rougher)});
  }
  return out + aligned_table(lines, 0);
}

std::string surfaces_json(const SurfacesView& view) {
  Json maps = Json::array(), rings = Json::array();
  for (const SurfaceView& map : view.maps) maps.push_back(Json::parse(surface_json(map)));
  for (const JointRing& ring : view.joint) {
    const Consensus c = consensus_at(ring.wavelength);
    rings.push_back({{"wavelength", ring.wavelength},
                     {"density", ring.density},
                     {"scatter", ring.maps > 1 ? Json(ring.scatter) : Json(nullptr)},
                     {"maps", ring.maps},
                     {"consensus_smoother", c.smoother > 0 ? Json(c.smoother) : Json(nullptr)},
                     {"consensus_rougher", c.rougher > 0 ? Json(c.rougher) : Json(nullptr)}});
  }
  return Json{{"schema", 1}, {"maps", maps}, {"joint", rings}, {"rms", view.rms}}.dump(2);
}

std::string with_scan(const std::string& document, const std::string& file,
                      const ScanChanges& changes) {
  Json out = Json::parse(document);
  out["scan"] = scan_json(file, changes);
  return out.dump(2);
}

}  // namespace papilla::report
