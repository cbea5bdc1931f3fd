// What the error bars are judged by: known rows summarised, and the random scenes.
#include "measure/coverage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "base/constants.h"
#include "geometry/texture.h"
#include "report/accuracy.h"

namespace papilla::tests::coverage_test {
namespace {

CoverageRow row(double value, double half_width, double reference, double reference_error = 0) {
  CoverageRow out;
  out.fidelity = "draft";
  out.quantity = "pull";
  out.value = value;
  out.half_width = half_width;
  out.reference = reference;
  out.reference_error = reference_error;
  return out;
}

TEST(Coverage, AReferenceAtTheEndOfABarIsInsideOnBothSides) {
  EXPECT_TRUE(row(2, 0.5, 2.5).inside());
  EXPECT_TRUE(row(2, 0.5, 1.5).inside());
  EXPECT_FALSE(row(2, 0.5, 2.625).inside());
  EXPECT_FALSE(row(2, 0.5, 1.375).inside());
}

// Errors of 1, 2, 3 and 4 bars of 2.5 and one that the reference's own error brings inside.
TEST(Coverage, SharesMediansAndRatiosOfKnownRows) {
  std::vector<CoverageRow> rows{row(1, 1, 2), row(5, 2, 3), row(0, 2.4, -3, 1), row(4, 4, 8)};
  rows.push_back(row(0, 7, 100));
  rows.back().quantity = "friction";
  rows.push_back(row(0, 7, 1));
  rows.back().fidelity = "search";
  const std::vector<CoverageSummary> s = coverage_summary(rows);
  ASSERT_EQ(s.size(), 3u);
  EXPECT_EQ(s[0].fidelity, "draft");
  EXPECT_EQ(s[0].quantity, "pull");
  EXPECT_EQ(s[0].scenes, 4);
  EXPECT_DOUBLE_EQ(s[0].inside, 0.75);
  EXPECT_DOUBLE_EQ(s[0].inside_both, 1);  // hypot(2.4, 1.96) = 3.1
  EXPECT_DOUBLE_EQ(s[0].median_half_width, 2.2);
  EXPECT_NEAR(s[0].error_quantile, 3.85, 1e-12);
  EXPECT_NEAR(s[0].rms_ratio, 1.96 * std::sqrt((3 + square(3 / 2.4)) / 4), 1e-12);
  EXPECT_EQ(s[1].quantity, "friction");
  EXPECT_EQ(s[1].inside, 0);
  EXPECT_EQ(s[2].fidelity, "search");
  EXPECT_EQ(s[2].inside, 1);
}

TEST(Coverage, TheReferenceStandsOnFreshSkinsWithoutControls) {
  CoverageOptions options;
  options.threads = 3;
  Fidelity f = coverage_reference(options);
  EXPECT_EQ(f.level, "design");
  EXPECT_EQ(f.grid, 256);
  EXPECT_EQ(f.skins, 48);
  EXPECT_EQ(f.threads, 3);
  EXPECT_EQ(f.first_skin, 1000);
  EXPECT_EQ(f.control_skins, 0);
  options.tight = true;
  f = coverage_reference(options);
  EXPECT_EQ(f.level, "reference");
  EXPECT_EQ(f.grid, 512);
  EXPECT_EQ(f.skins, 96);
}

// Of a thousand scenes the least and the largest are near the ends of their ranges, never beyond.
TEST(Coverage, RandomScenesFillTheirRangesAndNoMore) {
  const Scene plain;
  constexpr int kScenes = 1000;
  struct Range {
    double low, high;
    std::vector<double> of{};
  };
  Range rms{150e-9, 350e-9}, stiff{0.6, 1.6}, wet{0.3, 3}, angle{0.6, 1.9}, volts{80, 220},
      low{0.15, 0.45}, step{0.1, 0.3}, period{3e-6, 6e-6}, share{0.3, 0.6}, depth{50e-9, 900e-9};
  for (int i = 0; i < kScenes; ++i) {
    Texture texture;
    const Scene s = random_scene(i, texture);
    rms.of.push_back(s.finger.skin.rms);
    stiff.of.push_back(s.finger.skin.layer_modulus / plain.finger.skin.layer_modulus);
    EXPECT_DOUBLE_EQ(s.finger.skin.bulk_modulus / plain.finger.skin.bulk_modulus, stiff.of.back());
    wet.of.push_back(s.finger.water.volume[0] / plain.finger.water.volume[0]);
    EXPECT_DOUBLE_EQ(s.finger.water.volume[2] / plain.finger.water.volume[2], wet.of.back());
    angle.of.push_back(s.surface.contact_angle);
    volts.of.push_back(s.drive.amplitude);
    const std::vector<double>& rh = s.environment.relative_humidity;
    ASSERT_EQ(rh.size(), 2u);
    low.of.push_back(rh[0]);
    step.of.push_back(rh[1] - rh[0]);
    if (i % 8 == 0) {
      const auto& holes = std::get<HoleArray>(texture.kind);
      period.of.push_back(holes.period);
      share.of.push_back(holes.diameter / holes.period);
      depth.of.push_back(holes.depth);
      EXPECT_GE(holes.wall_angle, kPi / 6);
      EXPECT_LE(holes.wall_angle, kPi / 2);
      EXPECT_LE(2 * holes.depth / std::tan(holes.wall_angle), holes.diameter);  // walls do not meet
    }
  }
  for (const Range& r : {rms, stiff, wet, angle, volts, low, step, period, share, depth}) {
    const auto [least, largest] = std::minmax_element(r.of.begin(), r.of.end());
    const double room = 0.08 * (r.high - r.low);
    EXPECT_GE(*least, r.low * (1 - 1e-12));
    EXPECT_LE(*least, r.low + room);
    EXPECT_LE(*largest, r.high * (1 + 1e-12));
    EXPECT_GE(*largest, r.high - room);
  }
  // Factors are as often below their geometric mean as above it.
  for (const Range& r : {stiff, wet}) {
    const auto below = std::count_if(r.of.begin(), r.of.end(),
                                     [&](double v) { return v < std::sqrt(r.low * r.high); });
    EXPECT_NEAR(static_cast<double>(below) / kScenes, 0.5, 0.06);
  }
}

TEST(Coverage, RandomScenesTakeEveryKindUnderEveryFilm) {
  std::set<std::tuple<std::string, FilmProcess, std::size_t>> met;
  std::set<std::string> kinds;
  const double film = Scene{}.surface.dielectric.front().thickness;
  for (int i = 0; i < 32; ++i) {
    Texture texture;
    const Surface s = random_scene(i, texture).surface;
    kinds.insert(texture_name(texture));
    met.emplace(texture_name(texture), s.process, s.dielectric.size());
    const Relief relief = facts(texture).relief;
    const double thickness = s.dielectric.front().thickness;
    if (s.process == FilmProcess::Planar) {
      ASSERT_TRUE(relief.height()) << i;
      EXPECT_GE(i, 16);
      EXPECT_GE(thickness, film + *relief.height() - 1e-15);  // the film holds the texture
    } else {
      EXPECT_EQ(thickness, film);
    }
    if (i < 16) {
      EXPECT_EQ(s.process, i < 8 ? FilmProcess::Conformal : FilmProcess::Directional);
    }
    ASSERT_EQ(s.dielectric.size(), i < 24 ? 1u : 2u);
    if (i < 24) continue;
    const FilmDielectric& coat = s.dielectric.back();
    EXPECT_EQ(coat.made_by(s.process), FilmProcess::Conformal);
    EXPECT_GE(coat.permittivity, 6);
    EXPECT_LE(coat.permittivity, 10);
    EXPECT_GE(coat.thickness, 30e-9);
    EXPECT_LE(coat.thickness, 200e-9);
  }
  EXPECT_EQ(kinds.size(), 8u);
  // No planar film over a rough surface, with a coat or without: it has no stated depth.
  EXPECT_EQ(met.size(), 31u);
}

// The committed table is of these very scenes: one of its cheap rows, computed again.
TEST(Coverage, ARowOfTheCommittedTableIsWhatItsSceneGivesToday) {
  Texture texture;
  const Scene scene = random_scene(700, texture);
  Fidelity f = fidelity_level("design");
  f.grid = 64;
  f.skins = 12;
  f.estimator = Estimator::Load;
  f.seed = 701;
  const Response r = evaluate(scene, texture, f);
  int compared = 0;
  for (const CoverageRow& row :
       read_coverage(std::string(PAPILLA_SOURCE_DIR) + "/results/accuracy/coverage.csv")) {
    if (row.scene != 700 || row.fidelity != "64 pixels 12 skins load law") continue;
    if (row.quantity != "pull" && row.quantity != "capillary_force") continue;
    const Metric metric =
        *find_metric(row.quantity == "pull" ? "electrostatic_force" : row.quantity);
    EXPECT_NEAR(summarise(Summary::Mean, metric, r)->value, row.value, 2e-3 * row.value);
    ++compared;
  }
  EXPECT_EQ(compared, 2);
}

}  // namespace
}  // namespace papilla::tests::coverage_test
