#include "scene/finger.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"

namespace papilla::scene {

namespace {

// Of a quantity of the corneum, where a share of it is saturated and the rest in balance with the
// air. Eq. scene.10
double mixed(double with_air, double saturated, double hydration) {
  return (1 - hydration) * with_air + hydration * saturated;
}

// ln(X(75 %) / X(RH)) of what the corneum loses between 75 % and saturation: 0 to the logarithm of
// the ratio; slope: of the line below 75 %, for all the way to saturation. There it is four times
// the mean one, as sorbed water steepens. Delbourgo and Gregory's rational function: monotone for
// every slope and ratio. Eq. scene.1
double lost_above_75(double slope, double ratio, double relative_humidity) {
  const double end = std::log(ratio), t = (std::min(relative_humidity, 1.0) - 0.75) / 0.25;
  const double bow = t * (1 - t), below = end + (slope + 2 * end) * bow;
  return below > 0 ? end * (end * t * t + slope * bow) / below : 0;
}

}  // namespace

double Skin::modulus_factor(double relative_humidity) const {
  // Linear in RH through 1 at 15 % and 1/softening at 75 %, then on to saturation.
  const auto with_air = [this](double rh) {
    const double line = 1 - (1 - 1 / softening) / 0.6 * (std::min(rh, 0.75) - 0.15);
    if (rh <= 0.75) return line;
    const double slope = (softening - 1) / 0.6 * 0.25;  // of -ln E
    return line * std::exp(-lost_above_75(slope, softening_saturated, rh));
  };
  const double factor = with_air(relative_humidity);
  // Compliances add by their shares. Eq. scene.10
  return factor / mixed(1, factor / with_air(1), hydration);
}

double Skin::relief_factor() const { return mixed(1, relief_saturated, hydration); }

void fields(FieldVisitor& v, Skin& s) {
  v.number({"rms", "nm", 0, 1e5, "rms height over a 12 um patch", Source::Fit,
            "to M3; AFM anchors 200-350 nm"},
           s.rms);
  v.number(
      {"roll_off", "um", 0.05, 1e4, "roll-off wavelength of the spectrum", Source::Fit, "to M3"},
      s.roll_off);
  v.number({"hurst", "", 0.01, 1, "Hurst exponent", Source::Paper,
            "Sirin 2019: 0.86 on wrist skin; 0.8 usual"},
           s.hurst);
  v.number({"cutoff", "nm", 1, 1e5, "shortest wavelength of the spectrum", Source::Estimate,
            "model decision"},
           s.cutoff);
  v.path({"map", "measured skin topography (.npy .gsf .exr .tif) instead of the spectrum"}, s.map);
  v.number({"map_width", "um", 0, 1e6, "lateral size of the map where the file does not say"},
           s.map_width);
  v.number({"layer_thickness", "um", 0, 1e6, "thickness of the stiff top layer", Source::Paper,
            "M3: 1 um corneocyte plate"},
           s.layer_thickness);
  v.number({"layer_modulus", "MPa", 1e-6, 1e7, "Young's modulus of the layer at 15 % RH",
            Source::Fit, "to M3"},
           s.layer_modulus);
  v.number({"bulk_modulus", "MPa", 1e-6, 1e7, "Young's modulus below the layer at 15 % RH",
            Source::Fit, "to M3"},
           s.bulk_modulus);
  v.number({"layer_poisson", "", 0, 0.5, "Poisson ratio of the layer", Source::Estimate,
            "incompressible"},
           s.layer_poisson);
  v.number({"bulk_poisson", "", 0, 0.5, "Poisson ratio below the layer", Source::Estimate,
            "incompressible"},
           s.bulk_poisson);
  v.number({"softening", "", 1, 100, "ratio of the moduli at 15 % and 75 % RH (linear between)",
            Source::Fit, "to M3; 1.87-2.31 from the paper's ratios"},
           s.softening);
  v.number({"softening_saturated", "", 1, 1e4, "ratio of the moduli at 75 % RH and saturation",
            Source::Estimate,
            "tenfold in all by indentation (Yuan and Verma 2006), to 7 MPa; 1 to 10 MPa wet (Sirin "
            "2019); 700-fold in all in tension (Papir 1975)"},
           s.softening_saturated);
  v.number({"hardness", "MPa", 0, 1e6, "largest contact pressure; 0: no cap", Source::Choice,
            "the fit went without"},
           s.hardness);
  v.number({"hydration", "%", 0, 100,
            "share of the stratum corneum that is saturated; the rest is in balance with the air",
            Source::Choice, "0: as fitted; states and touch time add to it"},
           s.hydration);
  v.number({"relief_saturated", "", 0.05, 1,
            "rms height of the saturated stratum corneum over that of hydration 0",
            Source::Estimate, "hydrated skin is smoother (Sato 2000, Dabrowska 2016)"},
           s.relief_saturated);
  v.number({"occlusion_time", "s", 0.01, 1e5,
            "time constant of a touch: surface and sweat saturate the corneum in contact",
            Source::Estimate,
            "contact on glass grows by first-order kinetics, saturated within 20 s (Dzidek 2017)"},
           s.occlusion_time);
}

double MacroContact::gross_area(double load, double relative_humidity) const {
  const double growth = std::max(0.05, 1 + area_growth * (relative_humidity - 0.15) / 0.6);
  return area_15 * growth * std::pow(load / 0.2, load_exponent);
}

double MacroContact::shear_strength_at(double relative_humidity, double hydration) const {
  const auto with_air = [this](double rh) {
    const double line = std::max(0.05, 1 - shear_fall * (std::min(rh, 0.75) - 0.15) / 0.6);
    if (rh <= 0.75) return shear_strength * line;
    const double slope = shear_fall / 0.6 * 0.25 / line;
    return shear_strength * line *
           std::exp(-lost_above_75(slope, 1 / (1 - shear_fall_saturated), rh));
  };
  return mixed(with_air(relative_humidity), with_air(1), hydration);
}

void fields(FieldVisitor& v, MacroContact& s) {
  v.number({"area_15", "mm2", 1e-3, 1e4, "gross contact area at 0.2 N, 15 % RH", Source::Estimate,
            "100 mm2 at 1 N (Shultz 2018), exponent about 0.5"},
           s.area_15);
  v.number({"area_growth", "%", 0, 1000, "growth of that area from 15 to 75 % RH", Source::Paper,
            "M3: 58.5 %"},
           s.area_growth);
  v.number({"load_exponent", "", 0, 1, "exponent of the area against the load", Source::Estimate,
            "0.33-0.67 published"},
           s.load_exponent);
  v.number({"ridge_share", "", 0.001, 1, "share of the gross area on ridges", Source::Paper,
            "Shultz 2018: about 0.3"},
           s.ridge_share);
  v.number({"load_share", "", 1e-5, 1, "phi: share of the gross area that carries the load",
            Source::Fit, "to M3"},
           s.load_share);
  v.number({"shear_strength", "MPa", 1e-3, 1e3, "interfacial shear strength tau at 15 % RH",
            Source::Paper, "M3: 9 MPa"},
           s.shear_strength);
  v.number({"shear_fall", "%", 0, 95, "what tau loses from 15 to 75 % RH, linear between",
            Source::Fit, "to M3; 13 MPa dry, 5 MPa wet (Kovalev 2014)"},
           s.shear_fall);
  v.number({"shear_fall_saturated", "%", 0, 95, "what tau loses from 75 % RH to saturation",
            Source::Paper, "to 5 MPa, of wet skin (Kovalev 2014)"},
           s.shear_fall_saturated);
  v.number({"ridge_rms", "um", 1e-3, 1e4,
            "closures persson and balance: rms height of ridges above the patch size",
            Source::Estimate, "casts: below 5 um (Shultz 2015); see docs/theory/coupling.md"},
           s.ridge_rms);
  v.number({"ridge_longest", "mm", 1e-3, 1e3, "longest wavelength of that", Source::Estimate,
            "Sirin 2019: roll-off of wrist skin"},
           s.ridge_longest);
  v.number({"ridge_roll_off", "mm", 1e-3, 1e3,
            "its roll-off wavelength; the longest or more: without roll-off", Source::Choice,
            "no cast of a fingertip resolves it"},
           s.ridge_roll_off);
  v.number({"ridge_hurst", "", 0, 1, "its Hurst exponent; 0: that of the skin", Source::Choice,
            "no cast of a fingertip resolves it"},
           s.ridge_hurst);
  v.number({"pressure_peak", "", 1, 3,
            "closure balance: pressure in the middle of the fingertip over its mean; 1: even",
            Source::Estimate, "a paraboloid; Hertz 1.5 (Eq. macro.5)"},
           s.pressure_peak);
  v.number({"far_gaps", "", 0, 1,
            "closure balance: share of the open gaps that pull and hold water; 0: none",
            Source::Choice, "1: every gap of the ridges"},
           s.far_gaps);
  v.number(
      {"corneum_thickness", "um", 0, 1e5,
       "closures persson, balance: thickness of the stratum corneum", Source::Paper, "Sirin 2019"},
      s.corneum_thickness);
  v.number(
      {"tissue_modulus", "kPa", 1e-3, 1e9, "Young's modulus below it", Source::Paper, "Sirin 2019"},
      s.tissue_modulus);
}

double ElectricalLayer::equivalent_thickness(double relative_humidity, double hydration) const {
  const auto with_air = [this](double rh) {
    const double t = (rh - 0.15) / 0.6;
    const double line = std::max(0.0, thickness_15 + t * (thickness_75 - thickness_15));
    if (rh <= 0.75 || thickness_75 >= thickness_15) return line;
    // On with the same slope, and never nothing.
    return thickness_75 > 0 ? thickness_75 * std::exp((t - 1) * (1 - thickness_15 / thickness_75))
                            : 0;
  };
  return mixed(with_air(relative_humidity), with_air(1), hydration);
}

void fields(FieldVisitor& v, ElectricalLayer& s) {
  v.number(
      {"thickness_15", "nm", 0, 1e5, "stratum corneum d2/eps2 at 15 % RH", Source::Fit, "to M3"},
      s.thickness_15);
  v.number({"thickness_75", "nm", 0, 1e5, "the same at 75 % RH", Source::Fit, "to M3"},
           s.thickness_75);
  v.number({"corner_frequency", "Hz", 0, 1e9, "below it the stratum corneum conducts; 0: never",
            Source::Paper, "Sirin 2019: 376 1/s"},
           s.corner_frequency);
  v.number({"skin_exponent", "", 0.3, 1,
            "of the stratum corneum's capacitance, a constant-phase element; 1: a capacitor",
            Source::Choice, "1 as in the fits; palms .75 to .80 (Cole's law below 354 Hz)"},
           s.skin_exponent);
  v.number({"dispersion_frequency", "Hz", 1e-3, 1e9,
            "where a dispersive stratum corneum has the stated thickness", Source::Choice,
            "the drive of M3, which fitted it"},
           s.dispersion_frequency);
  v.number(
      {"gap_resistivity", "ohm m", 0, 1e30, "of the gap between skin and surface; 0: an insulator",
       Source::Paper, "Shultz 2018: 17 Mohm on 30 mm2 over 1.06 um"},
      s.gap_resistivity);
  v.number({"gap_exponent", "", 0.3, 1,
            "of the gap: above its corner it conducts as f^(1 - exponent); 1: a resistor",
            Source::Paper, "Shultz 2018: -20 dB a decade, a resistor beside a capacitor"},
           s.gap_exponent);
}

double SkinWater::volume_per_area(double rh) const {
  PAPILLA_CHECK(relative_humidity.size() == volume.size() && !volume.empty(),
                "one volume per humidity");
  constexpr double kPatchArea = 144e-12;  // the paper's 12 x 12 um window
  const std::size_t n = volume.size();
  if (n == 1) return volume[0] / kPatchArea;
  std::size_t i = 0;
  while (i + 2 < n && rh > relative_humidity[i + 1]) ++i;
  const double t = (rh - relative_humidity[i]) / (relative_humidity[i + 1] - relative_humidity[i]);
  if (volume[i] <= 0 || volume[i + 1] <= 0) {  // a dry node: linear, never negative
    return std::max(0.0, volume[i] + t * (volume[i + 1] - volume[i])) / kPatchArea;
  }
  return volume[i] * std::pow(volume[i + 1] / volume[i], t) / kPatchArea;
}

void fields(FieldVisitor& v, SkinWater& s) {
  v.numbers({"relative_humidity", "%", 0, 100, "humidity nodes of the water volumes", Source::Paper,
             "M3"},
            s.relative_humidity);
  v.numbers({"volume", "um3", 0, 1e6, "water in a 12 x 12 um patch at those nodes", Source::Fit,
             "to M3; only 5-10 um3 at 75 % is published"},
            s.volume);
  v.number({"contact_angle", "deg", 0, 180, "contact angle of water on the skin", Source::Paper,
            "M3: 80 deg, cleaned"},
           s.contact_angle);
  v.number(
      {"surface_tension", "mN/m", 0.1, 1000, "surface tension", Source::Measured, "IAPWS, 24 C"},
      s.surface_tension);
  v.number({"hysteresis", "", 0, 2, "cos(receding) - cos(advancing) of the weaker surface",
            Source::Estimate, "25 deg of hysteresis about 50 deg"},
           s.hysteresis);
  v.number(
      {"drops_per_um3", "", 1, 1e5, "initial droplets per um3 of water", Source::Paper, "M3: 100"},
      s.drops_per_um3);
  v.number({"volume_spread", "%", 0, 100,
            "both a low and a high volume, that far from the mean; 0: the mean alone",
            Source::Choice, "M3: 5 to 10 um3 at 75 % RH is 33 %"},
           s.volume_spread);
}

double Saturation::angle(double rest) const {
  const double t = (rest - rest_low) / (rest_high - rest_low);
  return std::clamp(saturated_low + t * (saturated_high - saturated_low), 0.0, rest);
}

void fields(FieldVisitor& v, Saturation& s) {
  v.number(
      {"rest_low", "deg", 0, 180, "first anchor: angle at rest", Source::Paper, "M3: bare glass"},
      s.rest_low);
  v.number({"saturated_low", "deg", 0, 180, "first anchor: saturated angle under voltage",
            Source::Fit, "to M3"},
           s.saturated_low);
  v.number({"rest_high", "deg", 0, 180, "second anchor: angle at rest", Source::Paper,
            "M3: hydrophobic"},
           s.rest_high);
  v.number(
      {"saturated_high", "deg", 0, 180, "second anchor: saturated angle", Source::Fit, "to M3"},
      s.saturated_high);
}

void fields(FieldVisitor& v, ModelOptions& s) {
  v.choice({"preset", "m3: the model as published; papilla: the same with the physics put right"},
           {"papilla", "m3"}, s.preset);
  v.choice({"water", "droplets, or the cheap threshold model (never for variability)"},
           {"droplets", "threshold"}, s.water);
  v.choice({"closure",
            "one patch pressure, Persson's distribution of patch pressures over a flat surface, or "
            "one balance of all gaps of the ridges over this one"},
           {"uniform", "persson", "balance"}, s.closure);
  v.choice({"coupling", "contact, water and field in equilibrium, or one pass as published"},
           {"one_pass", "equilibrium"}, s.coupling);
  v.choice(
      {"field", "column by column, with flux spreading in the dielectric, or the 3-D potential"},
      {"local", "spread", "full"}, s.field);
  v.choice({"air_limit",
            "what the air of a gap withstands: anything, 350 V/um, or that and 12 V in any gap"},
           {"none", "emission", "ionisation"}, s.air_limit);
  v.number({"droplet_step", "nm", 1, 1e5, "first step of a moving droplet: its mobility",
            Source::Choice, "to M3"},
           s.droplet_step);
  v.flag({"droplet_enhancement", "droplets that do not bridge raise the pull"},
         s.droplet_enhancement);
  v.flag({"rim_pinning", "contact lines do not pass the edges of holes (Gibbs)"}, s.rim_pinning);
  v.flag({"corner_wicking", "droplets at the foot of a wall creep along it (Concus and Finn)"},
         s.corner_wicking);
}

double Finger::patch_pressure(double relative_humidity) const {
  return load / (macro.load_share * macro.gross_area(load, relative_humidity));
}

void fields(FieldVisitor& v, SkinState& s) {
  v.number({"contact_angle", "deg", 0, 180, "of water on the skin", Source::Estimate,
            "unwashed skin 55 to 65 deg"},
           s.contact_angle);
  v.number({"water_factor", "", 0, 1e3, "on the sweat of the clean finger", Source::Estimate,
            "3 to 8 um3 against 0.3 to 1 um3 in a patch at 55 % humidity"},
           s.water_factor);
  v.number({"shear_factor", "", 0, 10,
            "on the shear strength of the clean finger, beside what hydration takes of it",
            Source::Estimate, "lipids: between 13 MPa dry and 5 MPa wet (Kovalev 2014)"},
           s.shear_factor);
  v.number({"hydration", "%", 0, 100,
            "share of the stratum corneum that is saturated: softer, electrically thinner",
            Source::Estimate, "soaked: all of it; sebum and sweat: as fitted on clean fingers"},
           s.hydration);
}

void fields(FieldVisitor& v, ParameterDeviation& s) {
  v.text({"parameter", "number of the finger, \"skin.rms\"; \"water.scale\": all volumes"},
         s.parameter);
  v.number({"deviation", "%", 0, 300, "its standard deviation, relative (of the logarithm)",
            Source::Fit, "papilla calibrate"},
           s.deviation);
  v.numbers({"correlation", "", -1, 1, "with the entries before this one; missing: 0", Source::Fit,
             "papilla calibrate"},
            s.correlation);
}

Finger Finger::touching_as(const Finger& other) const {
  Finger out = *this;
  out.load = other.load;
  out.state = other.state;
  out.touch_time = other.touch_time;
  return out;
}

Finger Finger::applied() const {
  Finger out = *this;
  // First-order kinetics of what is not saturated yet. Eq. scene.11
  out.touch_time = 0;
  out.skin.hydration = 1 - (1 - skin.hydration) * std::exp(-touch_time / skin.occlusion_time);
  if (state == FingerState::Clean) return out;
  const SkinState& change = state == FingerState::Natural ? natural : wet;
  out.state = FingerState::Clean;
  out.water.contact_angle = change.contact_angle;
  for (double& v : out.water.volume) v *= change.water_factor;
  out.macro.shear_strength *= change.shear_factor;
  out.skin.hydration = 1 - (1 - out.skin.hydration) * (1 - change.hydration);
  return out;
}

double Finger::skin_layer(double relative_humidity) const {
  return electrical.equivalent_thickness(relative_humidity, skin.hydration);
}

const std::vector<std::string>& finger_state_names() {
  static const std::vector<std::string> names{"clean", "natural", "wet"};
  return names;
}

void fields(FieldVisitor& v, Finger& s) {
  v.text({"name", "name of the finger"}, s.name);
  v.choice({"state", "clean (degreased), natural (sebum and sweat), wet"}, finger_state_names(),
           s.state);
  v.number({"load", "N", 0, 100, "normal force", Source::Paper, "M3: 0.2 N"}, s.load);
  v.number({"touch_time", "s", 0, 1e6,
            "how long it has touched, on what lets no water through; 0: as in the fitted papers",
            Source::Choice, "see skin.occlusion_time"},
           s.touch_time);
  v.section({"skin", "micro-topography and elasticity"}, s.skin);
  v.section({"macro", "gross contact and load-carrying share"}, s.macro);
  v.section({"electrical", "the stratum corneum as a dielectric"}, s.electrical);
  v.section({"water", "sweat against humidity"}, s.water);
  v.section({"natural", "what sebum and sweat change: state = \"natural\""}, s.natural);
  v.section({"wet", "what a film of water changes: state = \"wet\""}, s.wet);
  v.section({"saturation", "electrowetting saturation law"}, s.saturation);
  v.text({"fitted_to",
          "what the fit used, separated by spaces: published claims (papilla reproduce), and of "
          "numbers that are no claim C_gap and friction (papilla reproduce --figures)"},
         s.fitted_to);
  v.list({"uncertainty",
          "of fitted numbers: parameter, deviation, correlation (evaluate --parameters)"},
         s.uncertainty);
  v.path({"belief", "file of weighted members: what is not known of finger and model; \"\": none"},
         s.belief);
  v.section({"calibrated_for", "model options the finger was fitted with"}, s.calibrated_for);
}

}  // namespace papilla::scene
