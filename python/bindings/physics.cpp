// papilla/physics.h
#include <optional>

#include "convert.h"
#include "job.h"

namespace papilla::python {
namespace {

using namespace py::literals;

py::dict contact_row(ContactResult r, int ny, int nx) {
  return py::dict("converged"_a = r.converged, "reason"_a = r.reason,
                  "pressure"_a = map_of(std::move(r.pressure), ny, nx),
                  "gap"_a = map_of(std::move(r.gap), ny, nx), "area_fraction"_a = r.area_fraction,
                  "area_fraction_error"_a = r.area_fraction_error,
                  "mean_pressure"_a = r.mean_pressure, "approach"_a = r.approach,
                  "elastic_energy"_a = r.elastic_energy, "certificate"_a = r.certificate);
}

const char* name(WaterState state) {
  switch (state) {
    case WaterState::Dry:
      return "dry";
    case WaterState::Discs:
      return "discs";
    case WaterState::Film:
      return "film";
    case WaterState::Flooded:
      return "flooded";
  }
  return "";
}

const char* name(DropletPlace place) {
  switch (place) {
    case DropletPlace::Skin:
      return "skin";
    case DropletPlace::Substrate:
      return "substrate";
    case DropletPlace::Bridge:
      return "bridge";
  }
  return "";
}

py::dict droplets_row(DropletsResult r, int ny, int nx) {
  py::list places;
  for (const DropletState& d : r.droplets) places.append(name(d.place));
  const auto of = [&](double DropletState::*member) {
    return column(r.droplets, [&](const DropletState& d) { return d.*member; });
  };
  return py::dict("converged"_a = r.converged, "state"_a = name(r.state),
                  "x"_a = of(&DropletState::x), "y"_a = of(&DropletState::y),
                  "volume"_a = of(&DropletState::volume), "radius"_a = of(&DropletState::radius),
                  "height"_a = of(&DropletState::height), "force"_a = of(&DropletState::force),
                  "place"_a = places, "bridged"_a = owned(std::move(r.bridged), {ny, nx}),
                  "capillary_force"_a = r.capillary_force, "retention"_a = r.retention,
                  "wetted_fraction"_a = r.wetted_fraction, "bridges"_a = r.bridges,
                  "bridge_volume"_a = r.bridge_volume, "initial_energy"_a = r.initial_energy,
                  "final_energy"_a = r.final_energy);
}

py::dict field_row(FieldResult r, int ny, int nx) {
  // Of a field that failed there is no pressure.
  const bool whole = r.pressure.size() == static_cast<std::size_t>(ny) * nx;
  return py::dict("converged"_a = r.converged, "reason"_a = r.reason,
                  "pressure"_a = whole ? map_of(std::move(r.pressure), ny, nx) : map_of({}, 0, 0),
                  "mean_pressure"_a = r.mean_pressure, "force"_a = r.force,
                  "peak_air_field"_a = r.peak_air_field, "peak_oxide_field"_a = r.peak_oxide_field,
                  "residual"_a = r.residual);
}

py::dict bridge_row(const BridgeResult& b) {
  return py::dict("exists"_a = b.exists, "reason"_a = b.reason, "energy"_a = b.energy,
                  "force"_a = b.force, "pressure"_a = b.pressure, "radius1"_a = b.radius1,
                  "radius2"_a = b.radius2, "rupture_gap"_a = b.rupture_gap);
}

py::dict bind_droplets(const Array& z, double dx, double dy, double volume, const Water& water,
                       const DropletOptions& options) {
  const Heights gap = heights_of(z, dx, dy);
  return droplets_row(run_job([gap, volume, water, options](Job&) {
                        return droplets(gap, volume, water, options);
                      }),
                      gap.ny, gap.nx);
}

}  // namespace

void bind_physics(py::module_& module) {
  module.def(
      "contact",
      [](const Array& z, double dx, double dy, const std::vector<double>& solid, double pressure,
         double tolerance, double hardness) {
        const Heights h = heights_of(z, dx, dy);
        const Solid s{solid.at(0), solid.at(1), solid.at(2), solid.at(3), solid.at(4)};
        return contact_row(run_job([h, s, pressure, tolerance, hardness](Job&) {
                             return contact(h, s, pressure, tolerance, hardness);
                           }),
                           h.ny, h.nx);
      },
      py::arg("z"), py::arg("dx"), py::arg("dy"), py::arg("solid"), py::arg("pressure"),
      py::arg("tolerance"), py::arg("hardness"));
  module.def(
      "bridge",
      [](double volume, double gap, double theta1, double theta2, double surface_tension) {
        return bridge_row(
            run_job([=](Job&) { return bridge(volume, gap, theta1, theta2, surface_tension); }));
      },
      py::arg("volume"), py::arg("gap"), py::arg("theta1"), py::arg("theta2"),
      py::arg("surface_tension"));
  module.def(
      "droplets",
      [](const Array& z, double dx, double dy, double volume, double surface_tension,
         double theta_skin, double theta_substrate, double hysteresis, double drops_per_volume,
         double first_step, std::uint64_t seed, std::uint64_t index, bool threshold) {
        return bind_droplets(z, dx, dy, volume,
                             {surface_tension, theta_skin, theta_substrate, hysteresis},
                             {drops_per_volume, first_step, seed, index, threshold});
      },
      py::arg("z"), py::arg("dx"), py::arg("dy"), py::arg("volume"), py::arg("surface_tension"),
      py::arg("theta_skin"), py::arg("theta_substrate"), py::arg("hysteresis"),
      py::arg("drops_per_volume"), py::arg("first_step"), py::arg("seed"), py::arg("index"),
      py::arg("threshold"));
  py::enum_<FieldMethod>(module, "FieldMethod")
      .value("local", FieldMethod::Local)
      .value("spread", FieldMethod::Spread)
      .value("full", FieldMethod::Full);
  module.def(
      "field",
      [](const Array& z, double dx, double dy, double voltage, double thickness,
         double permittivity, double skin_layer, double edge_radius, bool dc, FieldMethod method,
         const std::optional<Array>& surface) {
        const Heights gap = heights_of(z, dx, dy);
        const auto below = surface ? std::optional(heights_of(*surface, dx, dy)) : std::nullopt;
        const FieldOptions options{thickness, permittivity, skin_layer, edge_radius, dc, method};
        return field_row(run_job([gap, voltage, options, below](Job&) {
                           return field(gap, voltage, options, below ? &*below : nullptr);
                         }),
                         gap.ny, gap.nx);
      },
      py::arg("z"), py::arg("dx"), py::arg("dy"), py::arg("voltage"), py::arg("thickness"),
      py::arg("permittivity"), py::arg("skin_layer"), py::arg("edge_radius"), py::arg("dc"),
      py::arg("method"), py::arg("surface"));
}

}  // namespace papilla::python
