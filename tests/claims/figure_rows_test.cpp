// The figures' tables on two skins of few pixels and a fingertip that hardly sweats: every row's
// name, and rows again from runs of their own.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/constants.h"
#include "claims/figures.h"
#include "claims/papers.h"
#include "forward/forward.h"
#include "published/targets.h"
#include "published/whole_finger.h"

namespace papilla::tests::figure_rows_test {
namespace {

const FigureOptions& few_pixels() {
  static const FigureOptions options = [] {
    FigureOptions o;
    for (double& volume : o.finger.water.volume) volume *= 0.05;  // droplets are what takes time
    o.threads = 1;
    o.sampling = {.level = "search", .skins = 2, .first_skin = 3, .grid = 32};
    return o;
  }();
  return options;
}

struct Run {
  FigureTables tables;
  std::vector<std::string> started;
};
const Run& run() {
  static const Run once = [] {
    Run out;
    FigureOptions options = few_pixels();
    options.started = [&](const std::string& sample) { out.started.push_back(sample); };
    out.tables = figure_tables(options);
    return out;
  }();
  return once;
}

FingerModel model_of(Preset preset) {
  return {few_pixels().finger, preset, 1, few_pixels().sampling};
}

struct Surface {
  std::string figures, sample;
  SampleCase of;
  std::vector<double> humidities{0.15, 0.35, 0.55, 0.75};
};

// As the paper shows them: six samples, two of them hydrophobic, three regions of films of large
// and of small particles at one humidity on a clean and on a natural finger.
std::vector<Surface> surfaces() {
  std::vector<Surface> out;
  const auto add = [&](const char* figures, const std::string& sample,
                       const std::string& design) -> Surface& {
    Surface one;
    one.figures = figures;
    one.sample = sample;
    one.of.design = design + ".toml";
    return out.emplace_back(std::move(one));
  };
  for (const std::string name : {"flat", "a3h350", "a3h600", "a3h900", "a4h350", "a4h600"})
    add("2d,e 3d-f", name, "m3_samples/" + name);
  for (const std::string name : {"flat", "a3h350"})
    add("4d,e", name + " 110°", "m3_samples/" + name).of.angle = 110;
  for (const FingerState state : {FingerState::Clean, FingerState::Natural}) {
    for (const char* size : {"large", "small"}) {
      for (const char* region : {"1", "2", "3"}) {
        Surface& film = add("4a", fmt::format("{} film {}", size, region),
                            fmt::format("coatings/hdpe_{}_{}", size, region));
        film.of.state = state;
        film.humidities = {0.55};
      }
    }
  }
  return out;
}

TEST(FigureRowsOfOneRun, StandInTheOrderOfThePaperByBothPresets) {
  const std::vector<FigureRow>& rows = run().tables.rows;
  std::vector<std::string> names;
  std::size_t at = 0;
  for (const Surface& s : surfaces()) {
    names.push_back(s.sample);
    for (const Preset preset : {Preset::Papilla, Preset::M3}) {
      for (const double rh : s.humidities) {
        ASSERT_LT(at, rows.size());
        const FigureRow& r = rows[at++];
        EXPECT_EQ(r.figures, s.figures) << s.sample;
        EXPECT_EQ(r.sample, s.sample);
        EXPECT_EQ(r.state, s.of.state == FingerState::Clean ? "clean" : "natural") << s.sample;
        EXPECT_EQ(r.preset, preset) << s.sample;
        EXPECT_NEAR(r.relative_humidity, rh, 1e-12) << s.sample;
      }
    }
  }
  EXPECT_EQ(rows.size(), at);
  names.push_back("printed numbers");
  EXPECT_EQ(run().started, names);
}

// Of two volumes, a third less and a third more, by six placements: the mean of both, the mean of
// their errors, the least and the largest.
void expect_value(const FigureValue& v, const std::string& what, double a, double a_se, double b,
                  double b_se) {
  const double room = 1e-9 * (std::abs(a) + std::abs(b)) + 1e-18;
  EXPECT_NEAR(v.value.value, 0.5 * (a + b), room) << what;
  EXPECT_NEAR(v.value.se, 0.5 * (a_se + b_se), room) << what;
  EXPECT_NEAR(v.low, std::min(a, b), room) << what;
  EXPECT_NEAR(v.high, std::max(a, b), room) << what;
}

void expect_rows(const Surface& s, Preset preset) {
  FingerModel model = model_of(preset);
  const Design design = read_design(find_design(s.of.design));
  Fidelity fidelity = model.fidelity();
  fidelity.droplet_seeds = 6;
  Scene scene = scene_of(model, s.of, design);
  Scene less = scene, more = scene;
  for (double& v : less.finger.water.volume) v *= 2.0 / 3;
  for (double& v : more.finger.water.volume) v *= 4.0 / 3;
  const Response a = evaluate(less, design.texture, fidelity),
                 b = evaluate(more, design.texture, fidelity);
  const double patch = a.plan.grid.lx * a.plan.grid.ly;
  std::size_t found = 0;
  for (const FigureRow& r : run().tables.rows) {
    if (r.sample != s.sample || r.preset != preset ||
        r.state != (s.of.state == FingerState::Clean ? "clean" : "natural"))
      continue;
    const ResponsePoint &p = a.points.at(found), &q = b.points.at(found);
    const auto expect = [&](const char* what, const FigureValue& v,
                            Measured PointQuantities::*member, double scale) {
      expect_value(v, s.sample + ", " + what, scale * (p.*member).value,
                   scale * (p.*member).parts.sampling, scale * (q.*member).value,
                   scale * (q.*member).parts.sampling);
    };
    expect("friction off", r.friction_off, &PointQuantities::friction_off, 1);
    expect("friction on", r.friction_on, &PointQuantities::friction_on, 1);
    expect("modulation", r.modulation, &PointQuantities::modulation, 1);
    // A patch has of the finger's forces what it has of its load.
    const double of_patch = p.patch_pressure * patch / design.finger.load;
    expect("capillary", r.capillary, &PointQuantities::capillary_force, of_patch);
    expect("pull", r.pull, &PointQuantities::electrostatic_force, of_patch);
    // What carries load is a share of the gross area on rigid glass; of a film that gives way it is
    // the strength of the contact over that of the material, which the finger's state lowers.
    const Finger& finger = few_pixels().finger;
    const MacroContact& macro = finger.macro;
    const double of_state = r.state == "clean" ? 1 : finger.natural.shear_factor;
    const double fall = 1 - macro.shear_fall * (r.relative_humidity - 0.15) / 0.6;
    expect("area", r.contact_area, &PointQuantities::area_fraction_off,
           s.figures == "4a"
               ? p.strength / (of_state * design.surface.shear_strength * fall)
               : macro.load_share * macro.gross_area(design.finger.load, r.relative_humidity));
    // The jackknife of two skins: half the difference of what each leaves out.
    const auto effect = [](const ResponsePoint& at) {
      return at.friction_on.value - at.friction_off.value;
    };
    const auto error = [&](const Response& of) {
      return 0.5 *
             std::abs(effect(of.without.at(0).at(found)) - effect(of.without.at(1).at(found)));
    };
    EXPECT_EQ(error(a) > 0, design.drive.amplitude > 0);
    expect_value(r.effect, s.sample + ", effect", effect(p), error(a), effect(q), error(b));
    ++found;
  }
  EXPECT_EQ(found, s.humidities.size());
}

TEST(FigureRowsOfOneRun, AreThoseOfRunsWithALittleAndWithMuchWater) {
  const std::vector<Surface> all = surfaces();
  expect_rows(all[1], Preset::Papilla);   // a3h350
  expect_rows(all[6], Preset::M3);        // flat at 110 deg
  expect_rows(all[9], Preset::M3);        // the second film of large particles
  expect_rows(all[18], Preset::Papilla);  // of small particles on a natural finger
}

TEST(FigureRowsOfOneRun, PrintedNumbersAreThoseOfTheTargetsAndOfTheVariation) {
  struct Printed {
    const char *claim, *what;
    double low, high;
  };
  const std::vector<Printed> expected{
      {"M1", "F_off(75 %) / F_off(15 %), flat", 2, 2},
      {"M2", "F_on(75 %) / F_on(15 %), flat", 2, 2},
      {"M3", "growth of the gross area, %", 58.5, 58.5},
      {"M4", "growth of the patch's real area, flat, %", 45.5, 45.5},
      {"M5", "area added by capillaries at 75 %, flat, %", 22.3, 24.1},
      {"M13", "110° against 50°, flat at 75 %, %", 130, 130},
      {"M15", "largest modulation at 110° without water", 1.38, 1.38},
      {"M17", "retention at 75 %, flat, % of F_off", 5, 5},
      {"C_gap", "gap of a sliding finger by its capacitance, um", 1.06, 1.06},
      {"friction", "friction coefficient, flat, 35 and 55 %", 0.2, 0.4},
      {"M14", "sd/mean of the modulation over humidity, flat 50°, %", 27.3, 27.3},
      {"M14", "sd/mean of the modulation over humidity, a3h350 110°, %", 6.7, 6.7},
      {"B3", "pull of a whole finger, 136 V at 25 kHz, 1 N, 1 um of oxide, mN", 609, 609},
      {"B3", "ΔF there, mN", 122, 122},
      {"B8", "amplitude of 4 mA there, V", 113, 150},
      {"P8", "friction coefficient under 200 V, 0.2 N over 2 N", 1, kInfinity}};
  FingerModel papilla = model_of(Preset::Papilla), m3 = model_of(Preset::M3);
  std::vector<PublishedTarget> targets = published_targets();
  for (const PublishedTarget& t : whole_finger_targets()) targets.push_back(t);
  const std::vector<PrintedNumber>& printed = run().tables.printed;
  ASSERT_EQ(printed.size(), expected.size());
  for (std::size_t i = 0; i < printed.size(); ++i) {
    const PrintedNumber& p = printed[i];
    EXPECT_EQ(p.claim, expected[i].claim);
    EXPECT_EQ(p.what, expected[i].what);
    EXPECT_EQ(p.low, expected[i].low) << p.what;
    EXPECT_EQ(p.high, expected[i].high) << p.what;
    for (const auto& [of, model] : {std::pair{&p.papilla, &papilla}, std::pair{&p.m3, &m3}}) {
      Estimate e;
      if (i == 10 || i == 11) {
        const Sample& s = i == 10 ? m3_sample(*model, "flat") : m3_sample(*model, "a3h350", 110);
        e.value = 100 * deviation_over_mean(s, Skins::all());
        e.se = 50 * std::abs(deviation_over_mean(s, Skins::without(0)) -
                             deviation_over_mean(s, Skins::without(1)));
      } else {
        const auto found = std::find_if(targets.begin(), targets.end(),
                                        [&](const PublishedTarget& t) { return t.what == p.what; });
        ASSERT_NE(found, targets.end()) << p.what;
        e = found->model(*model);
      }
      EXPECT_NEAR(of->value, e.value, 1e-9 * std::abs(e.value)) << p.what;
      EXPECT_NEAR(of->se, e.se, 1e-7 * e.se + 1e-12) << p.what;
    }
  }
}

// The finger alone, without belief: its misses are those of the printed numbers.
TEST(FigureRowsOfOneRun, TheFingerIsOneSetOfParameters) {
  const FigureTables& tables = run().tables;
  ASSERT_EQ(tables.sets.size(), 1u);
  const ParameterSet& own = tables.sets.front();
  EXPECT_EQ(own.name, few_pixels().finger.name);
  double largest = 0;
  for (std::size_t i = 0; i < tables.printed.size(); ++i) {
    const PrintedNumber& p = tables.printed[i];
    EXPECT_EQ(own.values[i], p.papilla.value);
    EXPECT_NEAR(own.misses[i] * p.validation_sd(), p.error(), 1e-12 * std::abs(p.error()));
    largest = std::max(largest, std::abs(own.misses[i]));
  }
  EXPECT_EQ(own.largest(), largest);
}

// On flat glass under a load of 1 N: the law of the pull on a parallel gap, as far as 30 mm^2 carry
// it, is the printed one.
TEST(WholeFinger, IsPrintedAsItsLawSays) {
  const double alpha = 0.2 * 30e-6 * 8.854e-12 / (2 * square(1.1e-6)), gap_volts = 105;
  const std::vector<PublishedTarget> targets = whole_finger_targets();
  EXPECT_NEAR(1e3 * alpha * square(gap_volts) / 2, targets[1].low, 0.02 * targets[1].low);
  EXPECT_NEAR(targets[1].low / 0.2, targets[0].low, 0.01 * targets[0].low);
  // 4 mA on 250 pF at 25 kHz, 90 % of all in the gap.
  EXPECT_NEAR(4e-3 / (2 * kPi * 25e3 * 250e-12) / 0.9, targets[2].low, 1);
}

}  // namespace
}  // namespace papilla::tests::figure_rows_test
