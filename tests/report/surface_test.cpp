// A measured map as people and programs read it: made-up numbers, each another.
#include "report/surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/constants.h"
#include "base/text.h"
#include "geometry/io/files.h"
#include "tests/report/same_json.h"
#include "tests/temporary.h"

namespace papilla::tests::surface_test {
namespace {

// Two rows of 144 pixels of 0.25 x 0.5 um: the first all 0, the second in pairs about 100 and 301.5
// nm.
SurfaceView made_up() {
  SurfaceView v;
  v.file = "scan.gsf";
  v.scan.map = {{144, 2, 36e-6, 1e-6}, std::vector<double>(288, 0.0)};
  for (int i = 0; i < 144; ++i) {
    constexpr double kPairs[] = {81e-9, 119e-9, 283e-9, 320e-9};
    v.scan.map(i, 1) = kPairs[i % 4];
  }
  v.scan.changes = {.width = 36e-6,
                    .height = 1e-6,
                    .slope_x = 0.003,
                    .slope_y = 0.004,
                    .rise = 540e-9,
                    .pixels = 288,
                    .replaced = 2,
                    .furthest = 3e-7,
                    .where = {1e-6, 2e-6, 3e-6, 4e-6},
                    .filled = 1};
  v.areal = {.sa = 10e-9,
             .sq = 12.5e-9,
             .sz = 95e-9,
             .sp = 55e-9,
             .sv = 40e-9,
             .ssk = -0.5,
             .sku = 3.25,
             .sdq = 0.15,
             .sdr = 0.011,
             .sampling_limited = true,
             .sal = 1.5e-6,
             .str = 0.25,
             .std = kPi / 3,
             .sk = 20e-9,
             .spk = 7e-9,
             .svk = 8e-9,
             .smr1 = 0.105,
             .smr2 = 0.885};
  v.spectrum = {{20e-6, 1e-24}, {10e-6, 2e-24}, {1e-6, 3e-24}, {0.5e-6, 4e-24}, {0.4e-6, 5e-24}};
  v.band = {10e-6, 0.5e-6, false};
  v.tip = 25e-9;
  return v;
}

TEST(SurfaceReport, ForPeopleHasEachNumberInTheUnitBesideIt) {
  SurfaceView v = made_up();
  const std::string page = surface_text(v);
  EXPECT_TRUE(page.starts_with(text(v.file, v.scan.changes) +
                               "\n36 x 1 um, 144 x 2 pixels of 250 x 500 nm\n\n"))
      << page;
  EXPECT_NE(page.find(aligned_table(
                {{"Sq", "12.5 nm", "rms height"},
                 {"Sa", "10 nm", "mean height"},
                 {"Sz", "95 nm", "highest 55 nm and lowest 40 nm from the mean"},
                 {"Ssk", "-0.5", "skewness: below 0 valleys, above 0 peaks"},
                 {"Sku", "3.25", "kurtosis: 3 of a Gaussian"},
                 {"Sdq", "0.15", "rms slope (grows with finer pixels)"},
                 {"Sdr", "1.1 %", "area beyond the flat one (grows with finer pixels)"},
                 {"Sal", "1.5 um", "autocorrelation falls to 0.2"},
                 {"Str", "0.25", "1: the same in all directions, 0: grooves"},
                 {"Std", "60.0 deg", "where the spectrum is strongest"},
                 {"Sk", "20 nm", "height of the core"},
                 {"Spk", "7 nm", "peaks above it, Smr1 10.5 %"},
                 {"Svk", "8 nm", "valleys below it, Smr2 88.5 %"}},
                3)),
            std::string::npos)
      << page;
  v.areal.sal.reset(), v.areal.str.reset(), v.areal.sampling_limited = false;
  const std::string far = surface_text(v);
  EXPECT_NE(far.find("longer than half the map"), std::string::npos);
  EXPECT_NE(far.find("not known: alike over half the map in some direction"), std::string::npos);
  EXPECT_EQ(far.find("grows with finer pixels"), std::string::npos);
}

TEST(SurfaceReport, WavesBeyondTheKnownBandAreMarked) {
  SurfaceView v = made_up();
  EXPECT_NE(surface_text(v).find("wavelengths that this map can know: 10 um (a quarter of its "
                                 "shorter side) to 500 nm (two pixels)\n"
                                 " um  C(q) um^4\n"
                                 " 20          1  beyond\n"
                                 " 10          2\n"
                                 "  1          3\n"
                                 "0.5          4\n"
                                 "0.4          5  beyond\n"),
            std::string::npos)
      << surface_text(v);
  v.band.by_tip = true;
  EXPECT_NE(surface_text(v).find("to 500 nm (a tip of 25 nm)\n"), std::string::npos);
  // A profile, or a few pixels.
  v.band = {0.25e-6, 0.5e-6, false};
  EXPECT_NE(surface_text(v).find("wavelengths that this map can know: none, 0.25 um (a quarter of "
                                 "its shorter side) is less than 500 nm (two pixels)\n"),
            std::string::npos)
      << surface_text(v);
}

// 48 bins of 6.67 nm: half of all heights in the first, an eighth in each of four; 72 columns of
// two pixels each.
TEST(SurfaceReport, TheHistogramAndTheSectionAreBarsOfEighths) {
  const auto blanks = [](std::size_t n) { return std::string(n, ' '); };
  std::string section;
  for (int i = 0; i < 36; ++i) section += "▁█";
  EXPECT_TRUE(surface_text(made_up()).ends_with(
      "\nheights from 0 to 320 nm\n█" + blanks(11) + "▂" + blanks(4) + "▂" + blanks(24) + "▂" +
      blanks(4) + "▂\n\nsection along x at y = 0.75 um, 81 to 320 nm\n" + section + "\n"))
      << surface_text(made_up());
  // Fewer pixels than columns: one each, from the lowest to the highest.
  SurfaceView few = made_up();
  few.scan.map = {{3, 1, 3e-6, 1e-6}, {-1e-9, 0, 1e-9}};
  EXPECT_TRUE(surface_text(few).ends_with(" y = 0.5 um, -1 to 1 nm\n ▄█\n")) << surface_text(few);
  few.scan.map.z = {2e-9, 2e-9, 2e-9};
  EXPECT_TRUE(surface_text(few).ends_with(" 2 to 2 nm\n   \n")) << surface_text(few);
}

TEST(SurfaceReport, ForProgramsIsInSi) {
  SurfaceView v = made_up();
  const nlohmann::json scan{{"file", "scan.gsf"},
                            {"as_is", false},
                            {"repeats", false},
                            {"made", false},
                            {"tilt", std::atan(0.005)},
                            {"slope", {0.003, 0.004}},
                            {"rise", 540e-9},
                            {"pixels", 288},
                            {"replaced", 2},
                            {"furthest", 3e-7},
                            {"where", {{"x", {1e-6, 2e-6}}, {"y", {3e-6, 4e-6}}}},
                            {"filled", 1},
                            {"marked", 0},
                            {"highest", 0},
                            {"rms", 0}};
  std::vector<double> shares(48, 0.0);
  shares[0] = 0.5, shares[12] = shares[17] = shares[42] = shares[47] = 0.125;
  const std::vector<double> section(v.scan.map.z.begin() + 144, v.scan.map.z.end());
  expect_document(surface_json(v),
                  {{"schema", 1},
                   {"scan", scan},
                   {"size", {36e-6, 1e-6}},
                   {"pixels", {144, 2}},
                   {"areal",
                    {{"Sa", 10e-9},
                     {"Sq", 12.5e-9},
                     {"Sz", 95e-9},
                     {"Sp", 55e-9},
                     {"Sv", 40e-9},
                     {"Ssk", -0.5},
                     {"Sku", 3.25},
                     {"Sdq", 0.15},
                     {"Sdr", 0.011},
                     {"slopes_sampling_limited", true},
                     {"Sal", 1.5e-6},
                     {"Str", 0.25},
                     {"Std", kPi / 3},
                     {"Sk", 20e-9},
                     {"Spk", 7e-9},
                     {"Svk", 8e-9},
                     {"Smr1", 0.105},
                     {"Smr2", 0.885}}},
                   {"band", {{"longest", 10e-6}, {"shortest", 0.5e-6}, {"by_tip", false}}},
                   {"spectrum",
                    {{{"wavelength", 20e-6}, {"density", 1e-24}},
                     {{"wavelength", 10e-6}, {"density", 2e-24}},
                     {{"wavelength", 1e-6}, {"density", 3e-24}},
                     {{"wavelength", 0.5e-6}, {"density", 4e-24}},
                     {{"wavelength", 0.4e-6}, {"density", 5e-24}}}},
                   {"histogram", {{"lowest", 0}, {"highest", 320e-9}, {"shares", shares}}},
                   {"section", {{"y", 0.75e-6}, {"heights", section}}}});
  expect_document(with_scan("{\"a\": 1}", "scan.gsf", v.scan.changes), {{"a", 1}, {"scan", scan}});
  v.scan.changes.replaced = 0;
  EXPECT_TRUE(nlohmann::json::parse(surface_json(v))["scan"]["where"].is_null());
}

// A wave of 100 nm and 2 um on 16 um: its rms and slope are known, its ring holds the most power,
// and a tip that is blunter than its crests, 1 / (A q^2), ends the band before the pixels do.
TEST(SurfaceReport, AFileIsReadWithItsTip) {
  Heightmap wave{{128, 64, 16e-6, 8e-6}, {}};
  const double q = 2 * kPi / 2e-6;
  for (int iy = 0; iy < 64; ++iy) {
    for (int ix = 0; ix < 128; ++ix) wave.z.push_back(100e-9 * std::sin(q * wave.grid.x(ix)));
  }
  const std::string path = temporary("wave.npy");
  write_npy(path, wave);
  const ScanSource source{.file = path, .width = 16e-6, .as_is = true};
  const SurfaceView sharp = view_of(source, 1e-9), blunt = view_of(source, 10 / (100e-9 * q * q));
  EXPECT_EQ(sharp.file, path);
  EXPECT_EQ(sharp.scan.map.z, wave.z);
  EXPECT_NEAR(sharp.areal.sq, 100e-9 / std::sqrt(2), 1e-12);
  const auto strongest = std::max_element(
      sharp.spectrum.begin(), sharp.spectrum.end(),
      [](const SpectrumRing& a, const SpectrumRing& b) { return a.density < b.density; });
  EXPECT_NEAR(std::log10(strongest->wavelength / 2e-6), 0, 0.1);
  EXPECT_NEAR(sharp.band.longest, 2e-6, 1e-12);
  EXPECT_NEAR(sharp.band.shortest, 250e-9, 1e-15);
  EXPECT_FALSE(sharp.band.by_tip);
  EXPECT_TRUE(blunt.band.by_tip);
  EXPECT_GT(blunt.band.shortest, 250e-9);
  EXPECT_EQ(blunt.tip, 10 / (100e-9 * q * q));
}

}  // namespace
}  // namespace papilla::tests::surface_test
