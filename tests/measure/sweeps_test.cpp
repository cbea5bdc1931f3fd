// Every choice of fidelity swept on a patch of few pixels.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/constants.h"
#include "measure/accuracy.h"

namespace papilla::tests::sweeps_test {
namespace {

TEST(AccuracySweepsOfOneRun, ErrorsAreAgainstTheLastOfASweepAndWorkIsThatOfItsTransforms) {
  Design design = read_design(find_design("m3_samples/flat.toml"));
  design.environment.relative_humidity = {0.55};
  AccuracyOptions options;
  options.grid = 16;
  options.skins = 2;
  options.finest = 64;
  options.levels = false;
  options.threads = 1;
  int notes = 0;
  options.note = [&](const std::string&) { ++notes; };
  const std::vector<AccuracyRow> rows = accuracy_sweeps(design, options);
  EXPECT_EQ(notes, static_cast<int>(rows.size()));
  std::map<std::string, std::vector<const AccuracyRow*>> sweeps;
  for (const AccuracyRow& r : rows) {
    sweeps[r.sweep].push_back(&r);
    const double n = square(static_cast<double>(r.fidelity.grid));
    EXPECT_NEAR(r.work, r.fft_pairs * n * std::log2(n) / (square(256.0) * 16), 1e-9 * r.work);
    ASSERT_EQ(r.value.size(), accuracy_quantities().size());
    ASSERT_EQ(r.stated.size(), r.value.size());
    ASSERT_EQ(r.error.size(), r.value.size());
  }
  const auto settings = [&](const std::string& sweep) {
    std::vector<std::string> out;
    for (const AccuracyRow* r : sweeps[sweep]) out.push_back(r->setting);
    return out;
  };
  using Texts = std::vector<std::string>;
  EXPECT_EQ(settings("grid"), (Texts{"32 pixels", "64 pixels"}));
  EXPECT_EQ(settings("skins"),
            (Texts{"4 skins", "8 skins", "16 skins", "32 skins", "64 skins", "128 skins"}));
  EXPECT_EQ(settings("tolerance"), (Texts{"1e-02", "1e-03", "1e-04", "1e-05", "1e-06", "1e-08"}));
  EXPECT_EQ(settings("field"), (Texts{"1e-01", "1e-02", "1e-03", "1e-04", "1e-06"}));
  EXPECT_EQ(settings("estimator"), (Texts{"load law", "solved areas"}));
  EXPECT_EQ(settings("model").back(), "as in the file");
  EXPECT_EQ(sweeps["seed"].size(), 6u);
  EXPECT_EQ(sweeps.count("level"), 0u);
  for (const auto& [sweep, list] : sweeps) {
    for (std::size_t q = 0; q < accuracy_quantities().size(); ++q) {
      double sum = 0;
      for (const AccuracyRow* r : list) {
        sum += r->error[q];
        if (sweep == "seed") continue;
        const double truth = list.back()->value[q];  // of one humidity no variation
        EXPECT_NEAR(r->error[q], truth == 0 ? 0 : r->value[q] / truth - 1, 1e-12)
            << sweep << ": " << r->setting;
      }
      if (sweep == "seed") {
        EXPECT_NEAR(sum, 0, 1e-9);  // against their mean
      }
    }
  }
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_EQ(sweeps["skins"][k]->fidelity.skins, 4 << k);
    EXPECT_EQ(sweeps["seed"][k]->fidelity.seed, k + 1);
    EXPECT_EQ(sweeps["tolerance"][k]->fidelity.contact_tolerance,
              std::stod(sweeps["tolerance"][k]->setting));
  }
  for (const AccuracyRow* r : sweeps["field"])
    EXPECT_EQ(r->fidelity.field_tolerance, std::stod(r->setting));
  EXPECT_EQ(sweeps["estimator"][0]->fidelity.estimator, Estimator::Load);
  EXPECT_EQ(sweeps["estimator"][1]->fidelity.estimator, Estimator::Area);
  EXPECT_EQ(sweeps["grid"][1]->fidelity.grid, 64);
  EXPECT_EQ(sweeps["grid"][1]->fidelity.skins, 2);
  // An option that is the file's own is no row; threshold water has another capillary force.
  std::map<std::string, const AccuracyRow*> model;
  for (const AccuracyRow* r : sweeps["model"]) model[r->setting] = r;
  EXPECT_EQ(
      model.count("field = spread") + model.count("field = local") + model.count("field = full"),
      2u);  // the file has the third
  ASSERT_TRUE(model.count("water = threshold"));
  EXPECT_NE(model["water = threshold"]->error[4], 0);
}

}  // namespace
}  // namespace papilla::tests::sweeps_test
