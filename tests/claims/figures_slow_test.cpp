// The M3 paper's figures as tables, on few skins and a coarse grid.
#include <gtest/gtest.h>

#include <set>

#include "claims/figures.h"
#include "design/design.h"
#include "report/figures.h"
#include "tests/claims/csv_rows.h"

namespace papilla::tests::figures_slow_test {
namespace {

const FigureTables& tables() {
  static const FigureTables once = [] {
    FigureOptions options;
    options.finger = read_finger(std::string(PAPILLA_DESIGNS_DIR) + "/fingers/reference.toml");
    options.finger.belief.clear();  // its members are asked elsewhere
    options.sampling.skins = 2;
    options.sampling.grid = 64;
    return figure_tables(options);
  }();
  return once;
}

const FigureRow& row(const std::string& sample, Preset preset, double humidity,
                     const std::string& state = "clean") {
  for (const FigureRow& r : tables().rows) {
    if (r.sample == sample && r.preset == preset && r.state == state &&
        std::abs(r.relative_humidity - humidity) < 1e-9)
      return r;
  }
  throw std::runtime_error("no row of " + sample);
}

TEST(FiguresOfOneRun, EverySampleStandsAtEveryHumidityByBothPresets) {
  std::set<std::tuple<std::string, std::string, Preset, double>> seen;
  for (const FigureRow& r : tables().rows)
    EXPECT_TRUE(seen.insert({r.sample, r.state, r.preset, r.relative_humidity}).second);
  // 8 samples at 4 humidities, 6 regions of films on 2 fingers at one.
  EXPECT_EQ(seen.size(), 2u * (8 * 4 + 6 * 2));
}

TEST(FiguresOfOneRun, NumbersOfARowBelongTogether) {
  for (const FigureRow& r : tables().rows) {
    for (const FigureValue* v : {&r.friction_off, &r.friction_on, &r.capillary, &r.pull}) {
      EXPECT_LE(v->low, v->value.value);
      EXPECT_GE(v->high, v->value.value);
      EXPECT_NEAR(0.5 * (v->low + v->high), v->value.value, 1e-12 + 1e-9 * v->value.value);
    }
    EXPECT_NEAR(r.friction_on.value.value - r.friction_off.value.value, r.effect.value.value,
                1e-12);
    EXPECT_GT(r.contact_area.value.value, 0);
  }
  // On a patch of 144 um2 that carries 0.2 N over 0.63 % of 45 mm2 the pull is some micronewtons.
  const FigureRow& flat = row("flat", Preset::Papilla, 0.15);
  EXPECT_GT(flat.pull.value.value, 1e-6);
  EXPECT_LT(flat.pull.value.value, 1e-3);
  EXPECT_NEAR(flat.contact_area.value.value * 9e6, flat.friction_off.value.value,
              0.02 * flat.friction_off.value.value);
}

TEST(FiguresOfOneRun, ThePresetsDifferAsThePaperHasIt) {
  EXPECT_EQ(row("flat 110\u00b0", Preset::M3, 0.75).capillary.value.value, 0);
  EXPECT_GT(row("flat 110\u00b0", Preset::Papilla, 0.75).capillary.value.value, 0);
  EXPECT_LT(row("flat", Preset::M3, 0.75).capillary.value.value,
            0.9 * row("flat", Preset::Papilla, 0.75).capillary.value.value);
  EXPECT_GT(row("small film 1", Preset::M3, 0.55, "natural").capillary.value.value, 0);
}

TEST(FiguresOfOneRun, PrintedNumbersStandBesideTheModels) {
  EXPECT_EQ(tables().printed.size(), 16u);
  const PrintedNumber ranged{"M5", "", 22.3, 24.1, 4, {12.05, 1}, {23, 1}};
  EXPECT_NEAR(ranged.deviation(ranged.papilla), 12.05 / 22.3 - 1, 1e-12);
  EXPECT_EQ(ranged.deviation(ranged.m3), 0);
  for (const PrintedNumber& n : tables().printed) {
    if (n.claim != "M5") continue;  // the force of the Laplace pressure alone is the smaller one
    EXPECT_GT(n.papilla.value, n.m3.value);
  }
  const std::string page = figures_markdown(tables(), "reference");
  EXPECT_NE(page.find("| M14 |"), std::string::npos);
  EXPECT_NE(page.find("## Fig. 2d"), std::string::npos);
  EXPECT_NE(page.find("## One set of parameters"), std::string::npos);
  const auto rows = csv_rows(figures_csv(tables()));
  EXPECT_EQ(rows.size(), tables().rows.size() + 1);
  for (const auto& cells : rows) EXPECT_EQ(cells.size(), rows[0].size());
  EXPECT_NEAR(std::stod(rows[1].at(13)), tables().rows[0].friction_off.value.value, 1e-4);
}

}  // namespace
}  // namespace papilla::tests::figures_slow_test
