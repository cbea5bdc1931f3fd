#include "report/pieces.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>

#include "base/constants.h"
#include "report/json.h"

namespace papilla::report {
namespace {

using Json = nlohmann::ordered_json;

const char* text_of(ContactStatus status) {
  switch (status) {
    case ContactStatus::Converged:
      return "converged";
    case ContactStatus::NoLoad:
      return "no load";
    case ContactStatus::Stagnated:
      return "stagnated";
    case ContactStatus::IterationLimit:
      return "iteration limit";
    case ContactStatus::Invalid:
      return "invalid";
    case ContactStatus::NotRun:
      return "not run";
  }
  return "";
}

const char* text_of(ContactMethod method) {
  switch (method) {
    case ContactMethod::Auto:
      return "auto";
    case ContactMethod::Dense:
      return "dense";
    case ContactMethod::Sparse:
      return "sparse";
  }
  return "";
}

std::string reason_of(const ContactSolution& s) {
  return s.reason.empty() ? text_of(s.status) : s.reason;
}

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (double v : values) sum += v / static_cast<double>(values.size());
  return sum;
}

// Approach of the mean planes since first touch [m].
double approach_of(const ContactSolution& s, const Heightmap& h) {
  return s.shift + *std::max_element(h.z.begin(), h.z.end());
}

double largest(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end());
}

}  // namespace

std::string contact_text(const ContactSolution& s, const ContactArea& area, const Heightmap& h,
                         double seconds) {
  return fmt::format(
      "{}: certificate {:.2g} after {} iterations ({}), {:.1f} transform pairs, {:.3g} s\n"
      "contact area      {:.4f} ±{:.4f} %  ({:.4f} % of pixels)\nmean gap          {:.5g} nm\n"
      "mean pressure     {:.5g} kPa\napproach          {:.5g} nm\nlargest pressure  {:.5g} "
      "MPa\nelastic energy    {:.5g} fJ\n",
      reason_of(s), s.certificate, s.iterations, text_of(s.method), s.fft_pairs, seconds,
      100 * area.near_edge, 100 * area.se, 100 * area.raw, 1e9 * mean_of(s.gap),
      1e-3 * mean_of(s.pressure), 1e9 * approach_of(s, h), 1e-6 * largest(s.pressure),
      1e15 * s.elastic_energy);
}

std::string contact_json(const ContactSolution& s, const ContactArea& area, const Heightmap& h,
                         double seconds) {
  return Json{{"schema", 1},
              {"converged", s.converged()},
              {"reason", reason_of(s)},
              {"method", text_of(s.method)},
              {"certificate", s.certificate},
              {"iterations", s.iterations},
              {"fft_pairs", s.fft_pairs},
              {"seconds", seconds},
              {"area_fraction_raw", area.raw},
              {"area_fraction", area.near_edge},
              {"area_fraction_se", area.se},
              {"area_fraction_perimeter", area.perimeter},
              {"mean_pressure", mean_of(s.pressure)},
              {"approach", approach_of(s, h)},
              {"mean_gap", mean_of(s.gap)},
              {"max_pressure", largest(s.pressure)},
              {"elastic_energy", s.elastic_energy}}
      .dump(2);
}

std::string bridge_text(const Bridge& bridge, const BridgeLimits& limits, double size) {
  std::string out;
  if (bridge.status == BridgeStatus::Converged) {
    out += fmt::format(
        "energy            {:.6g} fJ\nforce             {:.6g} nN ({})\n"
        "Laplace pressure  {:.6g} kPa\nradii             {:.6g} and {:.6g} nm\n",
        bridge.energy * 1e15, bridge.force * 1e9, bridge.force >= 0 ? "attracts" : "repels",
        bridge.pressure * 1e-3, bridge.radius1 * 1e9, bridge.radius2 * 1e9);
  } else {
    out += fmt::format("no bridge: {}\n", text(bridge.status));
  }
  if (limits.status != BridgeStatus::Converged) return out + "ruptures at       not found\n";
  if (limits.rupture == 0)
    return out + "no gap has one: water wets the one plate and keeps off the other\n";
  out += fmt::format("ruptures at       {:.6g} nm\n", limits.rupture * size * 1e9);
  if (limits.switching > 0) {
    out +=
        fmt::format("a droplet above   {:.6g} nm (lower energy)\n", limits.switching * size * 1e9);
  }
  return out;
}

std::string bridge_json(const Bridge& bridge, const BridgeLimits& limits, double size) {
  const bool exists = bridge.status == BridgeStatus::Converged;
  const bool known = limits.status == BridgeStatus::Converged;
  const auto number = [](bool there, double value) {
    return json_number(there ? std::optional(value) : std::nullopt);
  };
  return Json{{"schema", 1},
              {"exists", exists},
              {"reason", text(bridge.status)},
              {"energy", number(exists, bridge.energy)},
              {"force", number(exists, bridge.force)},
              {"laplace_pressure", number(exists, bridge.pressure)},
              {"radius1", number(exists, bridge.radius1)},
              {"radius2", number(exists, bridge.radius2)},
              {"rupture_gap", number(known, limits.rupture * size)},
              {"equilibrium_gap", number(known && limits.switching > 0, limits.switching * size)},
              {"snap_in_gap", number(known, limits.snap_in * size)},
              {"zero_force_gap", number(known && limits.zero_force > 0, limits.zero_force * size)}}
      .dump(2);
}

std::string field_text(const FieldSolution& s, const FieldRun& run) {
  return fmt::format(
      "{}: {}{}, {:.3g} s\nmean pressure     {:.6g} kPa\nlargest field     {:.4g} MV/m in air, "
      "{:.4g} MV/m in the dielectric ({:.3g} of its strength)\nair beyond limit  {:.1f} % of the "
      "area, {:.1f} % of the pull\n",
      run.method, s.ok ? "converged" : s.reason,
      run.iterates() && s.ok
          ? fmt::format(" to residual {:.1g} in {} iterations", s.residual, s.iterations)
          : "",
      run.seconds, 1e-3 * s.mean_pressure, 1e-6 * s.peak_air_field, 1e-6 * s.peak_oxide_field,
      run.strength > 0 ? s.peak_oxide_field / run.strength : 0.0, 100 * s.over_limit_area,
      100 * s.over_limit_share);
}

std::string field_json(const FieldSolution& s, const FieldRun& run) {
  const double margin = s.peak_oxide_field > 0 ? run.strength / s.peak_oxide_field : 0;
  Json out{{"schema", 1},
           {"converged", s.ok},
           {"reason", s.ok ? "converged" : s.reason},
           {"method", run.method},
           {"mean_pressure", s.mean_pressure},
           {"force", s.mean_pressure * run.area},
           {"peak_air_field", s.peak_air_field},
           {"peak_oxide_field", s.peak_oxide_field},
           {"oxide_margin", json_number(margin > 0 ? std::optional(margin) : std::nullopt)},
           {"over_limit_area", s.over_limit_area},
           {"over_limit_share", s.over_limit_share},
           {"seconds", run.seconds}};
  if (run.iterates()) {
    out["residual"] = s.residual;
    out["iterations"] = s.iterations;
  }
  return out.dump(2);
}

std::string optics_text(const Optics& look) {
  std::string out = fmt::format("regime         {}\n", text(look.regime));
  if (!look.refused()) {
    out += fmt::format(
        "haze           {:.3g} %  (ASTM D1003, ISO 14782)\n"
        "transmittance  {:.2f} %  undeviated; {:.2f} % in all (ISO 13468)\n"
        "gloss          {:.1f} GU at 60 deg, {:.1f} at 20, {:.1f} at 85 (ISO 2813)\n"
        "distinctness   {:.1f} %  of the reflected image at 20 deg (after ASTM D5767)\n",
        100 * look.haze, 100 * look.transmittance, 100 * look.total_transmittance, look.gloss,
        look.gloss_20, look.gloss_85, 100 * look.distinctness);
    if (look.sparkle > 0)
      out += fmt::format("sparkle        {:.2f} %  of the panel's subpixels\n", 100 * look.sparkle);
    out += fmt::format("colour shift   {:.4f} (u'v')\n\n{:>8} {:>8} {:>8} {:>8} {:>8}\n",
                       look.colour_shift, "deg", "nm", "haze %", "trans. %", "total %");
    for (const SpectrumPoint& p : look.spectrum) {
      out += fmt::format("{:>8.0f} {:>8.0f} {:>8.2f} {:>8.2f} {:>8.2f}\n", p.angle * 180 / kPi,
                         1e9 * p.wavelength, 100 * p.haze, 100 * p.transmitted, 100 * p.total);
    }
  }
  return look.warning.empty() ? out : out + "note: " + look.warning + '\n';
}

std::string optics_json(const Optics& look) {
  const bool refused = look.refused();
  const auto number = [&](double v) {
    return json_number(refused ? std::nullopt : std::optional(v));
  };
  Json spectrum = Json::array();
  for (const SpectrumPoint& p : look.spectrum) {
    spectrum.push_back({{"wavelength", p.wavelength},
                        {"angle", p.angle},
                        {"specular", p.specular},
                        {"haze", p.haze},
                        {"transmitted", p.transmitted},
                        {"total", p.total},
                        {"mirror", p.mirror}});
  }
  return Json{{"schema", 1},
              {"regime", text(look.regime)},
              {"warning", look.warning},
              {"haze", number(look.haze)},
              {"transmittance", number(look.transmittance)},
              {"total_transmittance", number(look.total_transmittance)},
              {"gloss", number(look.gloss)},
              {"gloss_20", number(look.gloss_20)},
              {"gloss_85", number(look.gloss_85)},
              {"distinctness", number(look.distinctness)},
              {"sparkle", number(look.sparkle)},
              {"colour_shift", number(look.colour_shift)},
              {"spectrum", spectrum}}
      .dump(2);
}

}  // namespace papilla::report
