#include "papilla/cases.h"

#include <chrono>
#include <limits>

#include "api/inside.h"
#include "cases/drive.h"
#include "cases/persson.h"
#include "report/drive.h"
#include "report/persson.h"

namespace papilla::api {
namespace {

PerssonPoint point_of(const MeanFieldPoint& p) {
  const PullState& pull = p.on.pull;
  const auto state = [&](double value) {
    return p.sound() ? value : std::numeric_limits<double>::quiet_NaN();
  };
  PerssonPoint out;
  out.voltage = p.voltage, out.load = p.load, out.frequency = p.frequency;
  out.collapsed = pull.status == PullStatus::Collapsed;
  out.breaks_down = p.breaks_down();
  out.yielded = p.yielded;
  out.area_off = p.area_off, out.area_on = state(pull.area);
  out.pressure = state(pull.pressure), out.pull = state(pull.pull);
  out.mean_gap = state(pull.mean_gap);
  out.friction = state(p.on.friction), out.coefficient = state(p.on.coefficient);
  out.capacitance = state(p.capacitance);
  return out;
}

std::vector<PerssonPoint> points_of(const std::vector<MeanFieldPoint>& points) {
  std::vector<PerssonPoint> out;
  for (const MeanFieldPoint& p : points) out.push_back(point_of(p));
  return out;
}

Document document_of(const CaseInput& input) {
  const std::vector<std::string> changes = overrides(input.values);
  return input.file.empty() ? parse_document(input.toml, "case.toml", changes, design_roots())
                            : load_document(own_or_shipped(input.file), changes, design_roots());
}

}  // namespace

PerssonResult persson(const CaseInput& input) {
  return across([&] {
    const MeanFieldCase c = read_mean_field(document_of(input));
    const auto begin = std::chrono::steady_clock::now();
    const MeanFieldResult r = solve_mean_field(c);
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return PerssonResult{r.rms,
                         r.slope,
                         r.contact_modulus,
                         point_of(r.point),
                         points_of(r.voltage),
                         points_of(r.load),
                         points_of(r.frequency),
                         mean_field_json(c, r, seconds),
                         mean_field_text(c, r, seconds)};
  });
}

DriveResult drive(const CaseInput& input) {
  return across([&] {
    const DriveCase c = read_drive_case(document_of(input));
    const rooms::DriveResult r = solve_drive(c);
    DriveResult out;
    out.period = r.friction.period;
    out.source_voltage = r.series.source_voltage.value;
    out.current = r.series.current.value;
    out.gap_voltage = r.series.gap_voltage.value;
    out.pull = r.series.force.value;
    out.friction = r.friction.value;
    for (const SpectrumLine& line : r.lines) {
      out.line_frequency.push_back(line.frequency);
      out.line_amplitude.push_back(line.amplitude);
    }
    out.mean_pull = r.series.mean_force;
    out.distortion = r.distortion;
    out.json = drive_json(c, r);
    out.table = drive_text(c, r);
    return out;
  });
}

}  // namespace papilla::api
