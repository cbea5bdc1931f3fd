// Tables of accuracy as people and programs read them: made-up numbers, each another.
#include "report/accuracy.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "base/files.h"
#include "base/text.h"
#include "report/tables.h"
#include "tests/report/same_json.h"
#include "tests/temporary.h"

namespace papilla::tests::accuracy_test {
namespace {

AccuracyRow row() {
  AccuracyRow r;
  r.sweep = "grid", r.setting = "64 pixels";
  r.fidelity.grid = 64, r.fidelity.skins = 12, r.fidelity.contact_tolerance = 2e-4;
  for (std::size_t q = 0; q < accuracy_quantities().size(); ++q) {
    r.value.push_back(2.0 + static_cast<double>(q));
    r.stated.push_back(0.25 + static_cast<double>(q));
    r.error.push_back(-0.03 * static_cast<double>(q + 1));
  }
  r.seconds = 1.25, r.fft_pairs = 345, r.work = 21.5, r.status = "ok, nearly";
  return r;
}

TEST(AccuracyReport, OfASweepHasEveryQuantityUnderItsName) {
  const AccuracyRow r = row();
  const std::string text = accuracy_text({r});
  const std::string line = text.substr(text.find('\n') + 1);
  EXPECT_TRUE(line.starts_with("grid       64 pixels ")) << line;
  EXPECT_NE(line.find("-3.00 %"), std::string::npos) << line;
  EXPECT_LT(line.find("-3.00 %"), line.find("-6.00 %"));
  EXPECT_TRUE(line.ends_with("       345      21.5     1.25\n")) << line;
  const std::string path = temporary("sweeps.csv");
  write_bytes(path, accuracy_csv({r}, "# made up\n"));
  const CsvTable table = read_csv(path);
  const auto json = nlohmann::json::parse(accuracy_json({r}))["sweeps"][0];
  for (std::size_t q = 0; q < accuracy_quantities().size(); ++q) {
    const std::string& name = accuracy_quantities()[q].name;
    EXPECT_EQ(table.numbers(name)[0], r.value[q]);
    EXPECT_EQ(table.numbers(name + "_stated")[0], r.stated[q]);
    EXPECT_EQ(table.numbers(name + "_error")[0], r.error[q]);
    expect_same(json["quantities"][name],
                {{"value", r.value[q]}, {"se", r.stated[q]}, {"relative_error", r.error[q]}}, name);
  }
  for (const auto& [name, value] : {std::pair{"grid", 64.0},
                                    {"skins", 12.0},
                                    {"tolerance", 2e-4},
                                    {"processor_seconds", 1.25},
                                    {"fft_pairs", 345.0},
                                    {"work", 21.5}})
    EXPECT_EQ(table.numbers(name)[0], value) << name;
  EXPECT_EQ(table.texts("sweep")[0], "grid");
  EXPECT_EQ(table.texts("setting")[0], "64 pixels");
  EXPECT_EQ(table.texts("estimator")[0], "area");
  EXPECT_EQ(table.texts("status")[0], "ok; nearly");
  for (const auto& [name, value] :
       {std::pair{"processor_seconds", 1.25}, {"fft_pairs", 345.0}, {"work", 21.5}})
    EXPECT_EQ(json[name], value) << name;
}

// Four scenes whose errors are 1, 2, 3 and 4 of a half-width of 3.92, so of two standard errors.
TEST(AccuracyReport, OfCoverageIsTheShareInside) {
  std::vector<CoverageRow> rows;
  for (int k = 0; k < 4; ++k) {
    CoverageRow r;
    r.scene = k, r.texture = "holes", r.fidelity = "draft", r.quantity = "friction";
    r.value = 100 + k + 1, r.half_width = 3.92, r.reference = 100, r.reference_error = 0.5;
    r.parts = {.sampling = 1, .grid = 1.5, .solver = 0.25, .method = 0.5};
    rows.push_back(r);
  }
  const CoverageSummary s = coverage_summary(rows).at(0);
  EXPECT_EQ(s.scenes, 4);
  EXPECT_EQ(s.inside, 0.75);
  EXPECT_EQ(s.inside_both, 1);  // 3.92 and 0.98 in squares: 4.04
  EXPECT_DOUBLE_EQ(s.median_half_width, 3.92);
  EXPECT_NEAR(s.error_quantile, 3.85, 1e-12);
  EXPECT_NEAR(s.rms_ratio, std::sqrt(7.5) / 2, 1e-12);
  const std::string text = coverage_text(rows);
  EXPECT_NE(text.find("draft                              friction              4     75 %        "
                      "3.92          3.85   1.02            1.37\n"),
            std::string::npos)
      << text;
  const auto json = nlohmann::json::parse(coverage_json(rows))["coverage"][0];
  for (const auto& [name, value] : {std::pair{"scenes", 4.0},
                                    {"inside", 0.75},
                                    {"inside_with_reference_error", 1.0},
                                    {"median_half_width", 3.92},
                                    {"error_quantile", s.error_quantile},
                                    {"rms_error_over_stated", s.rms_ratio}})
    EXPECT_EQ(json.at(name), value) << name;
  const std::string path = temporary("coverage.csv");
  write_bytes(path, coverage_csv(rows, "# made up\n"));
  const CsvTable table = read_csv(path);
  EXPECT_EQ(table.numbers("inside"), (std::vector<double>{1, 1, 1, 0}));
  for (const auto& [name, value] : {std::pair{"scene", 2.0},
                                    {"value", 103.0},
                                    {"half_width", 3.92},
                                    {"reference", 100.0},
                                    {"reference_error", 0.5},
                                    {"sampling", 1.0},
                                    {"grid", 1.5},
                                    {"method", 0.5},
                                    {"solver", 0.25}})
    EXPECT_EQ(table.numbers(name)[2], value) << name;
  const std::vector<CoverageRow> back = read_coverage(path);
  ASSERT_EQ(back.size(), 4u);
  EXPECT_EQ(back[2].scene, 2);
  EXPECT_EQ(back[2].value, 103);
  EXPECT_EQ(back[2].half_width, 3.92);
  EXPECT_EQ(back[2].reference, 100);
  EXPECT_EQ(back[2].reference_error, 0.5);
  EXPECT_EQ(back[2].texture + back[2].fidelity + back[2].quantity, "holesdraftfriction");
}

TEST(AccuracyReport, OfTheFieldRulesIsInPercentAndKilopascals) {
  FieldAccuracyRow r;
  r.sample = "flat", r.method = "full", r.relative_humidity = 0.35, r.pixels = 64;
  r.pull = 4500, r.error = -0.0125, r.seconds = 0.5;
  const std::string table = field_accuracy_csv({r});
  EXPECT_EQ(table.substr(table.find('\n') + 1), "flat,35,full,64,4.5,-1.25,0.5,ok\n");
}

// Value 2 with 0.25 stated, 12.5 %; -3 % of error is 0.062 off and within two of them.
TEST(AccuracyReport, ThePageHasARowASettingUnderItsSweep) {
  AccuracyRow grid = row(), off = row(), model = row(), level = row();
  const std::vector<AccuracyQuantity>& quantities = accuracy_quantities();
  off.setting = "32 pixels";
  off.stated[0] = 0.0125, off.error[0] = 0.25;  // 0.4 off: 32 of its errors
  off.error[1] = -0.5, off.stated[1] = 1.5;     // 3 off is two of them
  level.sweep = "level", level.error[0] = NAN, level.value[1] = 0, level.stated[1] = 0;
  level.error[1] = NAN;
  model.sweep = "model", model.error[0] = 0.5, model.stated[0] = 0.01;
  const std::string folder = temporary("accuracy");
  std::filesystem::create_directories(folder);
  write_bytes(folder + "/sweeps.csv", accuracy_csv({grid, off, model, level}, "# made up\n"));
  std::vector<CoverageRow> rows(2);
  for (int k = 0; k < 2; ++k) {
    CoverageRow& r = rows[static_cast<std::size_t>(k)];
    r.scene = k, r.texture = "holes", r.fidelity = "draft", r.quantity = "friction";
    r.value = 102 + 3 * k, r.half_width = 3.92, r.reference = 100;
  }
  write_bytes(folder + "/coverage.csv", coverage_csv(rows, "# of two scenes\n"));
  rows[0].fidelity = rows[1].fidelity = "tight";
  write_bytes(folder + "/coverage_tight.csv", coverage_csv(rows, "# again\n"));
  const std::string page = accuracy_page(folder);
  std::string head = "| setting |", rule = "|---|", line = "| 64 pixels | -3.00 % (12.5 %) |";
  for (std::size_t q = 0; q < quantities.size(); ++q) {
    head += " " + quantities[q].name + " |", rule += "---|";
    if (q == 0) continue;
    line += fmt::format(" {:.2f} % ({:.1f} %) |", 100 * grid.error[q],
                        100 * grid.stated[q] / grid.value[q]);
  }
  double modulation = 0;
  for (std::size_t q = 0; q < quantities.size(); ++q) {
    if (quantities[q].name == "modulation") modulation = grid.value[q];
  }
  ASSERT_GT(modulation, 0);
  head += " mean modulation | FFT pairs | work, pairs of 256² | processor seconds | status |\n";
  line += fmt::format(" {:.4f} | 345 | 21.5 | 1.25 | ok; nearly |\n", modulation);
  EXPECT_NE(page.find("docs/theory/accuracy.md.\n\n- made up\n\n## grid\n\nPixels along the patch; "
                      "same skins and droplets; error against the finest. Error of the value, in "
                      "brackets the standard error stated beside it.\n\n"
                      "![grid](../../results/accuracy/grid.svg)\n\n" +
                      head + rule + "---|---|---|---|---|\n" + line),
            std::string::npos)
      << page;
  EXPECT_NE(page.find("| 32 pixels | +25.00 % (0.6 %) | -50.00 % (50.0 %) |"), std::string::npos);
  EXPECT_NE(page.find("\nBeyond two of the standard errors stated: 32 pixels, " +
                      quantities[0].name + " (32.0).\n\n## model\n"),
            std::string::npos)
      << page;
  // Shifts of the model are no errors; what has no error has a dash.
  EXPECT_EQ(page.find("Beyond", page.find("## model")), page.find("Beyond", page.find("## level")));
  EXPECT_NE(page.find("| 64 pixels | – (12.5 %) | – (0.0 %) |", page.find("## level")),
            std::string::npos)
      << page;
  EXPECT_NE(page.find("\nBeyond two of the standard errors stated: none.\n\n## Error bars on "
                      "held-out scenes\n\n- of two scenes\n- again\n\n"),
            std::string::npos)
      << page;
  // Errors of 2 and 5: one within 3.92, their 95 % quantile 4.85, against 2: 1 and 2.5.
  const std::string numbers = "friction | 2 | 50 % | 50 % | 3.92 | 4.85 | 0.81 | 1.90 |\n";
  EXPECT_TRUE(page.ends_with("| draft | " + numbers + "| tight | " + numbers)) << page;
}

}  // namespace
}  // namespace papilla::tests::accuracy_test
