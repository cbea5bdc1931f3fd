#include "measure/accuracy.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>
#include <utility>

#include "base/constants.h"
#include "estimate/target.h"

namespace papilla::measure {
namespace {

double pair_work(const Fidelity& f) {
  const double n = square(static_cast<double>(f.grid)), unit = 65536;
  return n * std::log2(n) / (unit * 16);
}

class Sweeper {
 public:
  Sweeper(const Design& design, const AccuracyOptions& options)
      : design_(design), scene_(scene_of(design)), options_(options) {
    base_ = fidelity_level("design");
    base_.grid = options.grid;
    base_.skins = options.skins;
    base_.threads = options.threads;
  }

  std::vector<AccuracyRow> run() {
    grids();
    skins();
    seeds();
    tolerances();
    estimators();
    model();
    if (options_.levels) {
      levels();
      costs();
    }
    return std::move(rows_);
  }

 private:
  void grids() {
    for (int grid = 32; grid <= options_.finest; grid *= 2) {
      Fidelity f = base_;
      f.grid = grid;
      add("grid", fmt::format("{} pixels", grid), scene_, f);
    }
    compare("grid");
  }

  void skins() {
    for (int skins : {4, 8, 16, 32, 64, 128}) {
      Fidelity f = base_;
      f.skins = skins;
      add("skins", fmt::format("{} skins", skins), scene_, f);
    }
    compare("skins");
  }

  void seeds() {
    for (int seed = 1; seed <= 6; ++seed) {
      Fidelity f = base_;
      f.seed = static_cast<std::uint64_t>(seed);
      add("seed", fmt::format("seed {}", seed), scene_, f);
    }
    compare("seed", true);
  }

  void tolerances() {
    for (double tolerance : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-8}) {
      Fidelity f = base_;
      f.contact_tolerance = tolerance;
      add("tolerance", fmt::format("{:.0e}", tolerance), scene_, f);
    }
    compare("tolerance");
    for (double tolerance : {1e-1, 1e-2, 1e-3, 1e-4, 1e-6}) {
      Fidelity f = base_;
      f.field_tolerance = tolerance;
      add("field", fmt::format("{:.0e}", tolerance), scene_, f);
    }
    compare("field");
  }

  void estimators() {
    Fidelity load = base_;
    load.estimator = Estimator::Load;
    add("estimator", "load law", scene_, load);
    add("estimator", "solved areas", scene_, base_);
    compare("estimator");
  }

  // What the options of [model] move, each against the scene's own; few skins, as the 3-D field is
  // slow.
  void model() {
    Fidelity f = base_;
    f.skins = std::min(base_.skins, 4);
    f.control_skins = 0;
    const auto with = [&](const char* name, const auto& change) {
      Scene scene = scene_;
      change(scene.model);
      if (scene.model != scene_.model) add("model", name, scene, f);
    };
    with("water = threshold", [](ModelOptions& m) { m.water = WaterModel::Threshold; });
    with("field = local", [](ModelOptions& m) { m.field = FieldMethod::Local; });
    with("field = spread", [](ModelOptions& m) { m.field = FieldMethod::Spread; });
    with("field = full", [](ModelOptions& m) { m.field = FieldMethod::Full; });
    with("coupling = one_pass", [](ModelOptions& m) { m.coupling = Coupling::OnePass; });
    with("coupling = equilibrium", [](ModelOptions& m) { m.coupling = Coupling::Equilibrium; });
    with("closure = persson", [](ModelOptions& m) { m.closure = Closure::Persson; });
    with("air_limit = none", [](ModelOptions& m) { m.air_limit = AirLimit::None; });
    with("air_limit = emission", [](ModelOptions& m) { m.air_limit = AirLimit::Emission; });
    with("air_limit = ionisation", [](ModelOptions& m) { m.air_limit = AirLimit::Ionisation; });
    with("no droplet_enhancement", [](ModelOptions& m) { m.droplet_enhancement = false; });
    add("model", "as in the file", scene_, f);
    compare("model");
  }

  void levels() {
    for (const char* name : {"search", "draft", "design"}) level(name);
    const TargetOptions options{.target = 0.05, .threads = options_.threads};
    note("level: target 5 %");
    const std::clock_t begin = std::clock();
    const Response to_target = evaluate_to_target(scene_, design_.texture, options);
    push("level", "target 5 %", to_target, processor_seconds(begin));
    level("reference");
    compare("level");
  }

  void level(const char* name) { add("level", name, scene_, fidelity_of_level(name)); }

  Fidelity fidelity_of_level(const char* name) const {
    Fidelity f = fidelity_level(name);
    f.threads = options_.threads;
    return f;
  }

  // The root-mean-square error over four seeds against the reference, the last row so far, beside
  // the processor time of one of them: pixels and skins in turn, and the levels.
  void costs() {
    const std::vector<double> truth = rows_.back().value;
    for (int grid : {32, 64, 128, 256}) {
      for (int skins : {4, 12, 32}) {
        for (const auto& [estimator, name] :
             {std::pair{Estimator::Load, "load law"}, std::pair{Estimator::Area, "solved areas"}}) {
          Fidelity f = base_;
          f.grid = grid;
          f.skins = skins;
          f.estimator = estimator;
          cost(fmt::format("{} pixels {} skins {}", grid, skins, name), f, truth);
        }
      }
    }
    for (const char* name : {"draft", "design"}) cost(name, fidelity_of_level(name), truth);
  }

  void cost(const std::string& setting, Fidelity f, const std::vector<double>& truth) {
    constexpr int kSeeds = 4;
    AccuracyRow mean;
    for (int seed = 2; seed < 2 + kSeeds; ++seed) {  // none of the reference
      f.seed = static_cast<std::uint64_t>(seed);
      add("cost", setting, scene_, f);
      AccuracyRow row = std::move(rows_.back());
      rows_.pop_back();
      for (std::size_t q = 0; q < truth.size(); ++q)
        row.error.push_back(truth[q] == 0 ? 0 : square(row.value[q] / truth[q] - 1));
      if (seed == 2) {
        mean = std::move(row);
        continue;
      }
      for (std::size_t q = 0; q < truth.size(); ++q) {
        mean.value[q] += row.value[q];
        mean.stated[q] += row.stated[q];
        mean.error[q] += row.error[q];
      }
      mean.seconds += row.seconds;
      mean.fft_pairs += row.fft_pairs;
      mean.work += row.work;
    }
    for (std::size_t q = 0; q < truth.size(); ++q) {
      mean.value[q] /= kSeeds;
      mean.stated[q] /= kSeeds;
      mean.error[q] = std::sqrt(mean.error[q] / kSeeds);
    }
    mean.seconds /= kSeeds;
    mean.fft_pairs /= kSeeds;
    mean.work /= kSeeds;
    rows_.push_back(std::move(mean));
  }

  static double processor_seconds(std::clock_t begin) {  // of all threads
    return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  }

  void note(const std::string& text) const {
    if (options_.note) options_.note(text);
  }

  void add(const std::string& sweep, const std::string& setting, const Scene& scene,
           const Fidelity& fidelity) {
    note(sweep + ": " + setting);
    const std::clock_t begin = std::clock();
    const Response response = evaluate(scene, design_.texture, fidelity);
    push(sweep, setting, response, processor_seconds(begin));
  }

  void push(const std::string& sweep, const std::string& setting, const Response& r,
            double seconds) {
    AccuracyRow row{sweep, setting, r.fidelity, {}, {}, {}, seconds, r.fft_pairs, 0, "ok"};
    for (const AccuracyQuantity& q : accuracy_quantities()) {
      const auto v = summarise(q.summary, q.metric, r);
      row.value.push_back(v ? v->value : std::numeric_limits<double>::quiet_NaN());
      row.stated.push_back(v ? v->se : std::numeric_limits<double>::quiet_NaN());
    }
    row.work = r.fft_pairs * pair_work(r.fidelity);
    if (const auto troubles = r.troubles(); !troubles.empty()) row.status = text(troubles);
    if (r.accuracy.target > 0) row.status = text(r.accuracy);
    rows_.push_back(std::move(row));
  }

  // Errors of a finished sweep.
  void compare(const std::string& sweep, bool against_mean = false) {
    std::vector<AccuracyRow*> rows;
    for (AccuracyRow& row : rows_) {
      if (row.sweep == sweep) rows.push_back(&row);
    }
    for (std::size_t q = 0; q < accuracy_quantities().size(); ++q) {
      double truth = rows.back()->value[q];
      if (against_mean) {
        truth = 0;
        for (const AccuracyRow* row : rows)
          truth += row->value[q] / static_cast<double>(rows.size());
      }
      for (AccuracyRow* row : rows)
        row->error.push_back(truth == 0 ? (row->value[q] == 0 ? 0 : kInfinity)
                                        : row->value[q] / truth - 1);
    }
  }

  const Design& design_;
  Scene scene_;
  const AccuracyOptions& options_;
  Fidelity base_;
  std::vector<AccuracyRow> rows_;
};

}  // namespace

const std::vector<AccuracyQuantity>& accuracy_quantities() {
  static const std::vector<AccuracyQuantity> quantities{
      {"modulation", Summary::Mean, kModulation},
      {"variation", Summary::Variation, kModulation},
      {"friction", Summary::Mean, kFriction},
      {"contact_area", Summary::Mean, QuantityMetric{&PointQuantities::area_fraction_off}},
      {"capillary_force", Summary::Mean, QuantityMetric{&PointQuantities::capillary_force}},
      {"pull", Summary::Mean, QuantityMetric{&PointQuantities::electrostatic_force}}};
  return quantities;
}

std::vector<AccuracyRow> accuracy_sweeps(const Design& design, const AccuracyOptions& options) {
  return Sweeper(design, options).run();
}

}  // namespace papilla::measure
