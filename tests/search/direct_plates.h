// The yield of a design by evaluating every plate, to judge the one that is found from the ends of
// the tolerances.
#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

#include "base/error.h"
#include "metrics/metrics.h"
#include "search/problem.h"
#include "search/task.h"

namespace papilla::tests {

// A design whose limit on one metric is set so that a good part of its plates breaks it.
struct YieldCase {
  std::string name;
  std::string toml;          // design, space and scatter
  std::string metric, unit;  // that is limited
  int grid, skins;           // of the draft
  double below;  // the limit: so many standard deviations on the bad side of the nominal value
};

class JudgedYield {
 public:
  explicit JudgedYield(const YieldCase& of, int field_skins = fidelity_level("draft").field_skins)
      : study_(parse_study(
            of.toml + "[constraints]\n\"" + of.metric + "\" = \"0 " + of.unit + "\"\n", of.name)) {
    // A draft on fewer pixels and skins, without what only errors need: both sides alike.
    fidelity_ = fidelity_level("draft");
    fidelity_.grid = of.grid;
    fidelity_.skins = of.skins;
    fidelity_.control_skins = 0;
    fidelity_.field_skins = field_skins;
    fidelity_.threads = 1;
    const StudyProblem problem(study_);
    const Score score = judged(problem);
    const std::vector<LimitedNumbers>& at = score.by_task;
    double variance = 0;
    for (std::size_t k = 0; k < study_.scatter.size(); ++k) {
      const double slope = 0.5 * (at[2 + 2 * k].limited[0] - at[1 + 2 * k].limited[0]);
      variance += slope * slope / 3;
    }
    Constraint& limit = study_.constraints[0];
    limit.limit = at[0].limited[0] + (limit.at_least ? -1 : 1) * of.below * std::sqrt(variance);
  }

  const Study& study() const { return study_; }
  Yield by_the_ends() const {
    const StudyProblem problem(study_);
    return problem.yield(study_.design, judged(problem)).value();
  }
  // Of so many plates, with one tolerance scaled.
  double direct(int plates, std::size_t scaled = 0, double by = 1) const {
    const StudyProblem problem(study_);
    const ScatterLaw law(study_.scatter, study_.correlations);
    Plates made(study_, study_.design);
    int kept = 0;
    for (int i = 0; i < plates; ++i) {
      std::vector<double> u = law.plate(99, static_cast<std::uint64_t>(i));
      u[scaled] *= by;
      const Design& plate = made.plate(u);
      const TaskAnswer answer = evaluate_task(problem, plate, 0, {fidelity_});
      kept += answer.status.ok() && keeps(study_.constraints[0], answer.limited.at(0));
    }
    return static_cast<double>(kept) / plates;
  }

 private:
  Score judged(const StudyProblem& problem) const {
    std::vector<TaskAnswer> answers;
    for (std::size_t t = 0; t < problem.tasks().size(); ++t)
      answers.push_back(evaluate_task(problem, study_.design, t, {fidelity_}));
    const Score score = problem.score(study_.design, answers);
    if (!score.ok) throw InputError(score.reason);
    return score;
  }

  Study study_;
  Fidelity fidelity_;
};

// One finger at one humidity: a plate takes some hundredths of a second. The tolerances are wide
// enough to move the limited metric by more than what pixels and skins do.
inline std::vector<YieldCase> yield_cases() {
  const std::string head = "schema_version = 1\n[environment]\nrelative_humidity = [\"55 %\"]\n";
  const std::string driven = "[drive]\namplitude = \"200 V\"\nfrequency = \"5 kHz\"\n";
  const auto film = [](const char* thickness, const char* angle) {
    return fmt::format(
        "[surface]\nprocess = \"planar\"\ncontact_angle = \"{}\"\ndielectric = [{{ material = "
        "\"SiO2\", thickness = \"{}\", permittivity = 3.9, resistivity = \"1e14 ohm m\", strength "
        "= "
        "\"1 GV/m\" }}]\n",
        angle, thickness);
  };
  const std::string wish =
      "[design_space]\n\"surface.contact_angle\" = [\"40 deg\", \"90 deg\"]\n"
      "[objective]\nmaximise = \"mean(friction)\"\n";
  return {
      {"holes.toml",
       head + driven + film("800 nm", "60 deg") +
           "[texture]\ntype = \"hole_array\"\nperiod = \"4 um\"\ndiameter = \"2 um\"\ndepth = "
           "\"200 nm\"\n" +
           wish +
           "[scatter]\n\"surface.dielectric.0.thickness\" = \"120 nm\"\n\"texture.depth\" = \"60 "
           "nm\"\n\"surface.contact_angle\" = \"4 deg\"\n",
       "worst(modulation)", "", 64, 4, 0.8},
      {"pillars.toml",
       head + film("1 um", "60 deg") +
           "[texture]\ntype = \"pillar_array\"\nperiod = \"6 um\"\ndiameter = \"3 um\"\nheight = "
           "\"400 nm\"\n" +
           wish +
           "[scatter]\n\"texture.diameter\" = { sigma = \"60 nm\" }\n\"texture.height\" = { sigma "
           "= \"60 nm\" }\n\"surface.contact_angle\" = { sigma = \"6 deg\" }\ncorrelation = [{ "
           "between = [\"texture.diameter\", \"texture.height\"], value = 0.5 }]\n",
       "worst(friction)", "mN", 128, 16, 1.0},
      {"grooves.toml",
       head + driven + film("900 nm", "60 deg") +
           "[texture]\ntype = \"grating\"\nperiod = \"6 um\"\nwidth = \"2.5 um\"\ndepth = \"300 "
           "nm\"\nwall_angle = \"70 deg\"\n" +
           wish +
           "[scatter]\n\"texture.width\" = \"800 nm\"\n\"texture.depth\" = \"60 nm\"\n"
           "\"texture.wall_angle\" = \"10 deg\"\n\"surface.dielectric.0.thickness\" = \"90 nm\"\n",
       "worst(modulation)", "", 64, 4, 1.0},
      {"pillars_driven.toml",
       head + driven + film("1 um", "60 deg") +
           "[texture]\ntype = \"pillar_array\"\nperiod = \"5 um\"\ndiameter = \"3 um\"\nheight = "
           "\"300 nm\"\n" +
           wish +
           "[scatter]\n\"surface.dielectric.0.thickness\" = { sigma = \"30 nm\" }\n"
           "\"texture.height\" = { sigma = \"60 nm\" }\n\"texture.diameter\" = { sigma = \"250 "
           "nm\" "
           "}\n",
       "worst(modulation)", "", 64, 4, 1.2},
      {"shallow_holes.toml",
       head + driven + film("700 nm", "50 deg") +
           "[texture]\ntype = \"hole_array\"\nperiod = \"3 um\"\ndiameter = \"1.8 um\"\ndepth = "
           "\"150 nm\"\n" +
           wish +
           "[scatter]\n\"texture.depth\" = \"50 nm\"\n\"surface.dielectric.0.thickness\" = \"70 "
           "nm\"\n\"surface.contact_angle\" = { sigma = \"6 deg\" }\n",
       "worst(friction_on)", "mN", 64, 4, 0.6},
  };
}

}  // namespace papilla::tests
