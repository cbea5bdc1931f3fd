// The figures of the M3 paper as tables, and predictions: made-up numbers, each another.
#include "report/figures.h"

#include <gtest/gtest.h>

#include <string>

#include "report/predictions.h"
#include "tests/report/same_json.h"

namespace papilla::tests::figures_test {
namespace {

FigureValue around(double v) { return {{v, v / 10}, 0.8 * v, 1.25 * v}; }

FigureRow row(const char* figures, const char* sample, Preset preset, double humidity, double k) {
  FigureRow r;
  r.figures = figures, r.sample = sample, r.state = "clean";
  r.preset = preset, r.relative_humidity = humidity;
  r.capillary = around(2e-6 * k), r.pull = around(3e-6 * k);
  r.friction_off = around(4 * k), r.friction_on = around(5 * k), r.effect = around(6 * k);
  r.modulation = around(7 * k), r.contact_area = around(8e-6 * k);
  return r;
}

FigureTables made_up() {
  FigureTables t;
  t.rows = {row("2d,e 3d-f", "a, b", Preset::M3, 0.15, 1),
            row("2d,e 3d-f", "a, b", Preset::M3, 0.75, 2),
            row("4d,e", "screen", Preset::Papilla, 0.15, 10),
            row("4d,e", "screen", Preset::Papilla, 0.75, 20),
            row("4a", "flat", Preset::Papilla, 0.35, 1)};
  t.rows[2].state = t.rows[3].state = "wet";
  t.printed = {{"M2", "rise", 1.5, 2.5, 0.2, {2, 0.1}, {3, 0}},
               {"M7", "share", 0.5, 0.5, 0.03, {0.4, 0.02}, {1, 0}, 0.06}};
  return t;
}

TEST(FiguresReport, ALineHasEachNumberWithItsErrorAndLimitsInItsUnit) {
  const std::string csv = figures_csv(made_up());
  EXPECT_TRUE(csv.starts_with(
      "figures,sample,finger,preset,relative_humidity,capillary_uN,capillary_uN_se,"
      "capillary_uN_low,capillary_uN_high,pull_uN,pull_uN_se,pull_uN_low,pull_uN_high,"
      "friction_off_N,friction_off_N_se,friction_off_N_low,friction_off_N_high,friction_on_N,"
      "friction_on_N_se,friction_on_N_low,friction_on_N_high,effect_N,effect_N_se,effect_N_low,"
      "effect_N_high,modulation,modulation_se,modulation_low,modulation_high,contact_area_mm2,"
      "contact_area_mm2_se,contact_area_mm2_low,contact_area_mm2_high\n"
      "2d;e 3d-f,a; b,clean,m3,0.15,2,0.2,1.6,2.5,3,0.3,2.4,3.75,4,0.4,3.2,5,5,0.5,4,6.25,6,0.6,"
      "4.8,7.5,7,0.7,5.6,8.75,8,0.8,6.4,10\n"))
      << csv;
  EXPECT_NE(csv.find("\n4d;e,screen,wet,papilla,0.15,20,2,16,25,30,3,24,37.5,40,4,32,50,50,5,40,"
                     "62.5,60,6,48,75,70,7,56,87.5,80,8,64,100\n"),
            std::string::npos)
      << csv;
}

TEST(FiguresReport, AQuantityHasARowASurfaceOverHumidity) {
  const std::string page = figures_markdown(made_up(), "mine");
  EXPECT_NE(page.find("for the finger \"mine\""), std::string::npos);
  EXPECT_NE(
      page.find("## Printed numbers\n\n| claim | what | paper | papilla | preset m3 | E | "
                "u_num | u_input | u_D | u_val | \\|E\\|/u_val |\n"
                "|---|---|---|---|---|---|---|---|---|---|---|\n"
                "| M2 | rise | 1.5 to 2.5 | 2 ± 0.1 (+0 %) | 3 (+20 %) | +0 | 0.1 | no belief "
                "| 0.2 | 0.22 | 0 |\n"
                "| M7 | share | 0.5 | 0.4 ± 0.02 (-20 %) | 1 (+100 %) | -0.1 | 0.02 | 0.06 | "
                "0.03 | 0.07 | 1.4 |\n\nE: what"),
      std::string::npos)
      << page;
  EXPECT_NE(page.find("\n## Fig. 2d: capillary force on a patch, off [uN]\n\n"
                      "| sample | finger | preset | 15 % RH | 75 % RH |\n|---|---|---|---|---|\n"
                      "| a, b | clean | m3 | 2 ± 0.2 [1.6, 2.5] | 4 ± 0.4 [3.2, 5] |\n"
                      "| screen | wet | papilla | 20 ± 2 [16, 25] | 40 ± 4 [32, 50] |\n"
                      "\n## Fig. 2e: electrostatic force on a patch [uN]\n"),
            std::string::npos)
      << page;
  for (const char* line :
       {"force on a patch [uN]\n\n| sample | finger | preset | 15 % RH | 75 % RH |\n"
        "|---|---|---|---|---|\n| a, b | clean | m3 | 3 ± 0.3 [2.4, 3.75] |",
        "## Fig. 3d, 4d: friction off [N]\n\n| sample | finger | preset | 15 % RH | 75 % RH |\n"
        "|---|---|---|---|---|\n| a, b | clean | m3 | 4 ± 0.4 [3.2, 5] |",
        "## Fig. 3d, 4d: friction on [N]\n\n| sample | finger | preset | 15 % RH | 75 % RH |\n"
        "|---|---|---|---|---|\n| a, b | clean | m3 | 5 ± 0.5 [4, 6.25] |",
        "## Fig. 3e: ΔF [N]\n\n| sample | finger | preset | 15 % RH | 75 % RH |\n"
        "|---|---|---|---|---|\n| a, b | clean | m3 | 6 ± 0.6 [4.8, 7.5] |",
        "## Fig. 3f, 4e: ΔF/F_off\n\n| sample | finger | preset | 15 % RH | 75 % RH |\n"
        "|---|---|---|---|---|\n| a, b | clean | m3 | 7 ± 0.7 [5.6, 8.75] |"})
    EXPECT_NE(page.find(line), std::string::npos) << line << page;
  EXPECT_TRUE(
      page.ends_with("\n## Fig. 4a: real contact area [mm²]\n\n"
                     "| sample | finger | preset | 35 % RH |\n|---|---|---|---|\n"
                     "| flat | clean | papilla | 8 ± 0.8 [6.4, 10] |\n"))
      << page;
}

// One surface by two presets, or in two states, is two rows.
TEST(FiguresReport, ARowEndsWithItsSampleStateOrPreset) {
  FigureTables t;
  t.rows = {row("4a", "flat", Preset::M3, 0.35, 1), row("4a", "flat", Preset::Papilla, 0.35, 2),
            row("4a", "flat", Preset::Papilla, 0.35, 3),
            row("4a", "hole", Preset::Papilla, 0.35, 4)};
  t.rows[2].state = t.rows[3].state = "dirty";
  EXPECT_TRUE(
      figures_markdown(t, "f").ends_with("| flat | clean | m3 | 8 ± 0.8 [6.4, 10] |\n"
                                         "| flat | clean | papilla | 16 ± 2 [12.8, 20] |\n"
                                         "| flat | dirty | papilla | 24 ± 2 [19.2, 30] |\n"
                                         "| hole | dirty | papilla | 32 ± 3 [25.6, 40] |\n"))
      << figures_markdown(t, "f");
}

TEST(PredictionsReport, HasEachNumberBesideItsExperiment) {
  const std::vector<Prediction> two{
      {"pull over voltage", "flat, 75 to 150 V", "exponent", "", {2.125, 0.0625}, "75 V: 1 mN"},
      {"haze", "glass", "haze", "%", {12.5, 0}, ""}};
  EXPECT_EQ(predictions_text(two),
            "pull over voltage                              exponent 2.12 ± 0.062\n"
            "      flat, 75 to 150 V; 75 V: 1 mN\n"
            "haze                                           haze 12.5 %\n"
            "      glass\n");
  EXPECT_EQ(predictions_csv(two),
            "experiment,condition,quantity,unit,value,se,model,values,model_note\n"
            "pull over voltage,flat; 75 to 150 V,exponent,,2.125,0.0625,,75 V: 1 mN,\n"
            "haze,glass,haze,%,12.5,0,,,\n");
  EXPECT_TRUE(
      predictions_markdown(two, "mine")
          .ends_with(
              "for the finger \"mine\": what no fit has seen, before any comparison. ± is one "
              "standard "
              "error over skins; what is not known of finger and model is not in it: the finger "
              "names no belief.\n\n| experiment | condition | quantity | prediction | values |\n"
              "|---|---|---|---|---|\n"
              "| pull over voltage | flat, 75 to 150 V | exponent | 2.12 ± 0.062 | 75 V: 1 mN |\n"
              "| haze | glass | haze | 12.5 % |  |\n"))
      << predictions_markdown(two, "mine");
  expect_document(predictions_json(two, "mine"), {{"schema", 1},
                                                  {"finger", "mine"},
                                                  {"predictions",
                                                   {{{"id", "pull over voltage"},
                                                     {"condition", "flat, 75 to 150 V"},
                                                     {"quantity", "exponent"},
                                                     {"unit", ""},
                                                     {"value", 2.125},
                                                     {"se", 0.0625},
                                                     {"model", nullptr},
                                                     {"model_note", ""},
                                                     {"beside", "75 V: 1 mN"}},
                                                    {{"id", "haze"},
                                                     {"condition", "glass"},
                                                     {"quantity", "haze"},
                                                     {"unit", "%"},
                                                     {"value", 12.5},
                                                     {"se", 0},
                                                     {"model", nullptr},
                                                     {"model_note", ""},
                                                     {"beside", ""}}}}});
}

}  // namespace
}  // namespace papilla::tests::figures_test
