// The numbers of one solved patch and how each of them combines; and which quantity of a humidity
// is made of them, by which law and with which errors.
#pragma once

#include <array>
#include <span>

#include "base/constants.h"
#include "base/rooms.h"
#include "forward/measured.h"
#include "forward/status.h"
#include "papilla/quantities.h"

namespace papilla::forward {

// Processor time by piece of physics [s], summed over threads; in no reproducible file.
struct PieceSeconds {
  double contact = 0, water = 0, field = 0;
};

// What was spent; adds up over everything.
struct PatchCosts {
  int contact_solves = 0;
  double fft_pairs = 0;
  PieceSeconds seconds;

  PatchCosts& operator+=(const PatchCosts& other);
};

// Forces are on the patch [N], areas are fractions of it. "off": before the drive, "on": under it.
struct PatchResult {
  double load = 0;  // preload
  double capillary_off = 0, capillary_on = 0, pull = 0;
  double retention = 0, retention_on = 0;
  double area_dry = 0, area_off = 0, area_on = 0;
  double bridges = 0, wetted = 0, bridge_volume = 0, volume = 0;
  double on_its_way = 0;                 // water of bridges between disc and film [m^3]
  double mean_gap = 0, indentation = 0;  // [m]
  double over_limit_area = 0, over_limit_share = 0, peak_oxide_field = 0, peak_air_field = 0;
  double oxide_margin = kInfinity;  // strength of the dielectric over its peak field
  double certificate = 0;           // the worst of the contact solves
  double coupling_residual = 0;     // of the equilibrium, in units of the total load
  PatchCosts costs;
  ModelStatus status;
};

// Over volumes and placements of the water on one skin. Common: of the dry contact, which they
// share.
enum class OverWater { Common, Mean, Highest, Lowest };

// Over the patch pressures of one humidity (closures persson, balance), to a mean patch of the
// load-carrying area: by the share of patches at each pressure under the nominal load, before or
// under the drive; over the patches in contact alone; of the pull; or given by the fingertip.
// `ScaleBridge::combine`
enum class OverPressures { Given, Nominal, Off, On, Touching, OfPull, Highest, Lowest };

struct PatchMember {
  double PatchResult::*value;
  OverWater water;
  OverPressures pressures;
};
// Every number of a patch, in any order.
inline constexpr std::array kPatchMembers{
    PatchMember{&PatchResult::load, OverWater::Common, OverPressures::Given},
    PatchMember{&PatchResult::capillary_off, OverWater::Mean, OverPressures::Off},
    PatchMember{&PatchResult::capillary_on, OverWater::Mean, OverPressures::On},
    PatchMember{&PatchResult::pull, OverWater::Mean, OverPressures::On},
    PatchMember{&PatchResult::retention, OverWater::Mean, OverPressures::Off},
    PatchMember{&PatchResult::retention_on, OverWater::Mean, OverPressures::On},
    PatchMember{&PatchResult::area_dry, OverWater::Common, OverPressures::Nominal},
    PatchMember{&PatchResult::area_off, OverWater::Mean, OverPressures::Off},
    PatchMember{&PatchResult::area_on, OverWater::Mean, OverPressures::On},
    PatchMember{&PatchResult::bridges, OverWater::Mean, OverPressures::Touching},
    PatchMember{&PatchResult::wetted, OverWater::Mean, OverPressures::Touching},
    PatchMember{&PatchResult::bridge_volume, OverWater::Mean, OverPressures::Touching},
    PatchMember{&PatchResult::volume, OverWater::Mean, OverPressures::Touching},
    PatchMember{&PatchResult::on_its_way, OverWater::Mean, OverPressures::Touching},
    PatchMember{&PatchResult::mean_gap, OverWater::Common, OverPressures::Touching},
    PatchMember{&PatchResult::indentation, OverWater::Common, OverPressures::Touching},
    PatchMember{&PatchResult::over_limit_area, OverWater::Mean, OverPressures::Touching},
    PatchMember{&PatchResult::over_limit_share, OverWater::Mean, OverPressures::OfPull},
    PatchMember{&PatchResult::peak_oxide_field, OverWater::Highest, OverPressures::Highest},
    PatchMember{&PatchResult::peak_air_field, OverWater::Highest, OverPressures::Highest},
    PatchMember{&PatchResult::oxide_margin, OverWater::Lowest, OverPressures::Lowest},
    PatchMember{&PatchResult::certificate, OverWater::Highest, OverPressures::Highest},
    PatchMember{&PatchResult::coupling_residual, OverWater::Highest, OverPressures::Highest}};
static_assert(sizeof(PatchResult) ==
                  kPatchMembers.size() * sizeof(double) + sizeof(PatchCosts) + sizeof(ModelStatus),
              "every member says how it combines");

// What a humidity answers, each with its errors.
using PointQuantities = api::Quantities<Measured>;

// What is missing on a grid to the limit of fine pixels, and by which law it goes: Eq. accuracy.2
enum class GridLaw { Area, Pull, Modulation, Other };

// Which part of the band that the droplets leave open reaches the quantity: Eq. capillary.19, 20
enum class WaterBand { None, Capillary, Pull, LoadOff, LoadOn };

struct PointQuantity {
  Measured PointQuantities::*value;
  double PatchResult::*mean_of;  // over the skins; null: by a law of its own (forward/point.cpp)
  bool whole_finger;             // mean_of is a force on a patch: times the patches of a finger
  GridLaw grid;
  WaterBand water;
};
// One row per quantity of papilla/quantities.h, in that order: where it comes from and how its
// errors do.
inline constexpr std::array kPointQuantities{
    PointQuantity{&PointQuantities::friction_off, nullptr, true, GridLaw::Area, WaterBand::LoadOff},
    PointQuantity{&PointQuantities::friction_on, nullptr, true, GridLaw::Area, WaterBand::LoadOn},
    PointQuantity{&PointQuantities::modulation, nullptr, false, GridLaw::Modulation,
                  WaterBand::Pull},
    PointQuantity{&PointQuantities::area_fraction_off, nullptr, false, GridLaw::Area,
                  WaterBand::LoadOff},
    PointQuantity{&PointQuantities::area_fraction_on, nullptr, false, GridLaw::Area,
                  WaterBand::LoadOn},
    PointQuantity{&PointQuantities::capillary_force, &PatchResult::capillary_off, true,
                  GridLaw::Other, WaterBand::Capillary},
    PointQuantity{&PointQuantities::electrostatic_force, &PatchResult::pull, true, GridLaw::Pull,
                  WaterBand::Pull},
    PointQuantity{&PointQuantities::retention_force, &PatchResult::retention, true, GridLaw::Other,
                  WaterBand::Capillary},
    PointQuantity{&PointQuantities::bridges, &PatchResult::bridges, false, GridLaw::Other,
                  WaterBand::Capillary},
    PointQuantity{&PointQuantities::wetted_fraction, &PatchResult::wetted, false, GridLaw::Other,
                  WaterBand::Capillary},
    PointQuantity{&PointQuantities::mean_gap, &PatchResult::mean_gap, false, GridLaw::Other,
                  WaterBand::None},
    PointQuantity{&PointQuantities::indentation, &PatchResult::indentation, false, GridLaw::Other,
                  WaterBand::None}};
// friction_by_load: Eq. friction.4, of which no area is part.
GridLaw grid_law(Measured PointQuantities::*quantity, bool friction_by_load = false);

// By which power of the load contact areas and friction go: alike where friction is that of the
// areas (Eq. friction.3), friction by 1 with a coefficient (Eq. friction.4).
struct LoadExponents {
  double area = 0, friction = 0;

  double of(Measured PointQuantities::*quantity) const;
};
inline LoadExponents load_exponents(double of_areas, double coefficient) {
  return {of_areas, coefficient > 0 ? 1 : of_areas};
}
static_assert(
    [] {
      bool same = kPointQuantities.size() == api::kQuantities<Measured>.size();
      for (std::size_t k = 0; same && k < kPointQuantities.size(); ++k)
        same = kPointQuantities[k].value == api::kQuantities<Measured>[k].value;
      return same;
    }(),
    "every quantity says where it comes from");

// One result for the skin: costs add up, the first trouble or pull-in counts.
PatchResult over_water(std::span<const PatchResult> members);

// The share of patches at each patch pressure: under the nominal load, before and under the drive.
struct PressureShares {
  std::vector<double> nominal, off, on;
  // How much harder patches press than at their own pressure, and touch on more in proportion.
  double press_off = 1, press_on = 1;
};
// Adds the results at each pressure to `out`, which holds what the fingertip gives.
void add_over_pressures(std::span<const PatchResult> patches, const PressureShares& shares,
                        PatchResult& out);

}  // namespace papilla::forward
