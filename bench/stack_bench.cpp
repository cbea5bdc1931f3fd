// What each part of the stack gains, and whether the order of a front holds under better models.
//   stack_bench fronts SKINS GRID MOST CSV SVG NAME=STUDY:FRONT...
//       the designs of each FRONT (`pareto.csv` of a search of STUDY), at most MOST of each, judged
//       again on the same skins, that no search has seen; hypervolumes with their gains over the
//       front before, paired errors; the picture of them
//   stack_bench order STUDY FRONT MOST SKINS
//       a front under the levels of the search, solved areas on 256 pixels, the 3-D field and
//       self-consistent coupling: how often the order of two designs holds; CSV on standard output
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/files.h"
#include "bench/front_file.h"
#include "numerics/statistics.h"
#include "optim/pareto.h"
#include "report/svg.h"
#include "search/problem.h"
#include "search/task.h"

using namespace papilla::tests;

namespace {

constexpr int kFreshSkins = 100000;

Score judged(const StudyProblem& problem, const Design& design, const Fidelity& fidelity) {
  std::vector<TaskAnswer> answers;
  for (std::size_t t = 0; t < problem.tasks().size(); ++t)
    answers.push_back(evaluate_task(problem, design, t, {fidelity, true}));
  return problem.score(design, answers);
}

// Of minimised objectives, from all skins or without one of them.
std::vector<double> objectives(const StudyProblem& problem, const Score& score,
                               std::optional<std::size_t> skin) {
  std::vector<double> out;
  for (std::size_t k = 0; k < score.values.size(); ++k) {
    const std::vector<double>& samples = score.samples.at(k).sampling;
    double v = score.values[k];
    if (skin) {
      const double mean = mean_estimate(samples).value;
      v -= (samples.at(*skin) - mean) / static_cast<double>(samples.size() - 1);
    }
    out.push_back(problem.objectives()[k].maximise ? -v : v);
  }
  return out;
}

struct Front {
  std::string name;
  std::vector<Score> scores;
  std::vector<double> mean, mean_error, variation, variation_error;
  double volume = 0;
  std::vector<double> samples;  // of the volume: their standard error is its own
};

// Mean modulation 0.2 and variation 0.45: beyond every front of the glass studies.
const std::vector<double> kReference{-0.2, 0.45};

double volume(const StudyProblem& problem, const Front& front, std::optional<std::size_t> skin) {
  std::vector<std::vector<double>> points;
  for (const Score& s : front.scores) points.push_back(objectives(problem, s, skin));
  return hypervolume(points, kReference);
}

Front judged_front(const std::string& text, const Fidelity& fidelity, std::size_t most) {
  const std::size_t equals = text.find('='), colon = text.find(':');
  if (equals == std::string::npos || colon == std::string::npos)
    throw InputError(text + ": expected NAME=STUDY:FRONT");
  const Study study = read_study(text.substr(equals + 1, colon - equals - 1));
  const StudyProblem problem(study);
  Front out;
  out.name = text.substr(0, equals);
  for (const Point& u : read_front(text.substr(colon + 1), problem, most)) {
    const Design design = problem.space().design(u);
    const Score score = judged(problem, design, fidelity);
    if (!score.ok || !problem.feasible(score, design)) continue;
    out.mean.push_back(score.values.at(0));
    out.mean_error.push_back(score.errors[0]);
    out.variation.push_back(score.values.at(1));
    out.variation_error.push_back(score.errors[1]);
    out.scores.push_back(score);
  }
  out.volume = volume(problem, out, std::nullopt);
  std::vector<double> without;
  for (int k = 0; k < fidelity.skins; ++k)
    without.push_back(volume(problem, out, static_cast<std::size_t>(k)));
  out.samples = jackknife_samples(out.volume, without);
  return out;
}

void fronts(const std::vector<std::string>& a) {
  Fidelity fidelity = fidelity_level("design");
  fidelity.skins = std::stoi(a.at(1));
  fidelity.grid = std::stoi(a.at(2));
  fidelity.first_skin = kFreshSkins;
  const std::size_t most = std::stoul(a.at(3));
  std::string table =
      "front,mean(modulation),se,variation(modulation),se,hypervolume,se,gain over the front "
      "before,se\n";
  SvgPlot plot{"What each part of the stack gains",
               "variation of the modulation over humidity",
               "mean modulation",
               {},
               false};
  const std::vector<std::string> colours{"#8a8a8a", "#1b6ca8", "#2e8b57", "#c0392b", "#7d3c98"};
  std::optional<Front> before;
  for (std::size_t i = 6; i < a.size(); ++i) {
    const Front front = judged_front(a[i], fidelity, most);
    for (std::size_t d = 0; d < front.mean.size(); ++d)
      table += fmt::format("{},{:.4f},{:.4f},{:.4f},{:.4f},,,,\n", front.name, front.mean[d],
                           front.mean_error[d], front.variation[d], front.variation_error[d]);
    table += fmt::format("{},,,,,{:.4f},{:.4f}", front.name, front.volume,
                         mean_estimate(front.samples).se);
    if (before) {
      std::vector<double> gain = front.samples;
      for (std::size_t k = 0; k < gain.size(); ++k) gain[k] -= before->samples[k];
      table +=
          fmt::format(",{:.4f},{:.4f}\n", front.volume - before->volume, mean_estimate(gain).se);
    } else {
      table += ",,\n";
    }
    SvgSeries series{front.name,
                     colours[(i - 6) % colours.size()],
                     front.variation,
                     front.mean,
                     front.variation_error,
                     front.mean_error};
    series.line = true;
    plot.series.push_back(series);
    before = front;
  }
  write_bytes(a.at(4), table);
  write_bytes(a.at(5), svg_picture({plot}));
}

struct Model {
  std::string name;
  FieldMethod field = FieldMethod::Spread;
  Coupling coupling = Coupling::OnePass;
  Estimator estimator = Estimator::Area;
  int grid = 128;
  int field_skins = -1;  // whose pull is corrected to the 3-D field; -1: as the level has it
};

// Of pairs of designs: how many change places in an objective, and how many of those whose
// difference is larger than twice its error.
void order(const std::vector<std::string>& a) {
  const Study study = read_study(a.at(1));
  const StudyProblem problem(study);
  const std::vector<Point> designs = read_front(a.at(2), problem, std::stoul(a.at(3)));
  const std::vector<Model> models{
      {"as confirmed, 256 pixels", FieldMethod::Spread, Coupling::OnePass, Estimator::Area, 256},
      {"128 pixels"},
      {"load law, 128 pixels", FieldMethod::Spread, Coupling::OnePass, Estimator::Load},
      {"load law, 64 pixels", FieldMethod::Spread, Coupling::OnePass, Estimator::Load, 64},
      {"the same, corrected to the 3-D field of a skin", FieldMethod::Spread, Coupling::OnePass,
       Estimator::Load, 64, 1},
      {"3-D field, 128 pixels", FieldMethod::Full},
      {"equilibrium, 128 pixels", FieldMethod::Spread, Coupling::Equilibrium}};
  fmt::print(
      "model,processor s a design,objective,pairs,in order,told apart,in order of these,values\n");
  std::vector<Score> truth;
  for (const Model& model : models) {
    Fidelity f = fidelity_level(model.estimator == Estimator::Load ? "search" : "design");
    f.estimator = model.estimator;
    f.grid = model.grid;
    f.skins = std::stoi(a.at(4));
    f.first_skin = kFreshSkins;
    if (model.field_skins >= 0) f.field_skins = model.field_skins;
    std::vector<Score> scores;
    const auto from = std::clock();
    for (const Point& u : designs) {
      Design d = problem.space().design(u);
      d.model.field = model.field;
      d.model.coupling = model.coupling;
      scores.push_back(judged(problem, d, f));
    }
    const double each = static_cast<double>(std::clock() - from) / CLOCKS_PER_SEC /
                        static_cast<double>(designs.size());
    if (truth.empty()) truth = scores;
    for (std::size_t k = 0; k < problem.objectives().size(); ++k) {
      int pairs = 0, kept = 0, apart = 0, apart_kept = 0;
      std::string values;
      for (std::size_t i = 0; i < designs.size(); ++i) {
        values += scores[i].ok ? fmt::format(" {:.3f}", scores[i].values[k]) : " none";
        for (std::size_t j = 0; j < i; ++j) {
          if (!scores[i].ok || !scores[j].ok || !truth[i].ok || !truth[j].ok) continue;
          const double was = truth[i].values[k] - truth[j].values[k];
          const bool same = was * (scores[i].values[k] - scores[j].values[k]) > 0;
          const bool told = std::abs(was) > 2 * difference_error(truth[i], truth[j], k);
          ++pairs;
          kept += same;
          apart += told;
          apart_kept += told && same;
        }
      }
      fmt::print("\"{}\",{:.2f},{},{},{},{},{},{}\n", model.name, each,
                 problem.objectives()[k].name, pairs, kept, apart, apart_kept, values);
    }
    std::fflush(stdout);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> a(argv + 1, argv + argc);
  try {
    if (!a.empty() && a[0] == "fronts") return fronts(a), 0;
    if (!a.empty() && a[0] == "order") return order(a), 0;
    throw InputError("stack_bench fronts | order: see the head of bench/stack_bench.cpp");
  } catch (const std::exception& e) {
    fmt::print(stderr, "error: {}\n", e.what());
    return 2;
  }
}
