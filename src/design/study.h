// A study: a design, what of it may change, and what is wanted. Read from TOML with every mistake
// at once, written back with the origin of each value.
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"
#include "config/node.h"
#include "config/reader.h"
#include "design/design.h"
#include "design/limits.h"
#include "design/paths.h"
#include "design/scatter.h"
#include "optim/problem.h"

namespace papilla::design {

// One number that the search may change; or the texture's kind ("texture.type", by its place in
// texture_kinds()) or how many parts of a stack there are ("texture.levels").
struct Variable {
  std::string path;                  // into Design: "texture.diameter"
  std::string unit;                  // for people
  double low = 0, high = 0;          // SI
  std::vector<double> choices;       // SI; when not empty, one of these
  std::vector<Excluded> excluded{};  // SI; between low and high

  bool is_kind() const { return path == "texture.type"; }
  bool is_levels() const { return path == "texture.levels"; }

  bool operator==(const Variable&) const = default;
};

// Whether a number is one of what is built, so that a search may choose it, and not of who touches
// it, in which air, or how that is calculated.
bool is_built(const std::string& path);

// What a metric should be at every humidity.
struct Target {
  Metric metric;
  double value = 0;  // SI

  bool operator==(const Target&) const = default;
};

// Two objectives make a Pareto front.
struct Objective {
  std::vector<MetricExpression> maximise, minimise;
  std::vector<Target> targets;  // the root mean square distance from each is minimised
  std::string risk;  // "mean - 2 std", "cvar 20 %", "worst"; "": mean over the population

  bool operator==(const Objective&) const = default;
};

// A state of the product that counts beside the others: new, worn.
struct Scenario {
  std::string name;
  double weight = 1;
  std::vector<Setting> set;  // numbers of the design that this scenario fixes

  bool operator==(const Scenario&) const = default;
};

// What is not known of finger and model, where the fingers name a belief. What fingers, scenarios
// and scatter do is objective.risk.
struct StudyRisk {
  std::string belief = "regret";  // or "mean", "worst 10 %": decides among the finalists
  double limits = 0.9;            // probability to keep every limit with, of what is recommended

  bool operator==(const StudyRisk&) const = default;
};
void fields(FieldVisitor& v, StudyRisk& s);

struct Search {
  std::string method = "auto";
  int seed = 1;
  int evaluations = 0;      // 0: as many as the time allows, or the method's default
  int drafts = 0;           // besides; of the Gaussian process alone
  double time = 0;          // wall clock [s]; 0: no limit
  int jobs = 0;             // 0: all processors
  double rounding = 10e-9;  // grid of the fab for the build sheet [m]; 0: none

  bool operator==(const Search&) const = default;
};
void fields(FieldVisitor& v, Search& s);

struct Study {
  Design design;
  std::vector<Variable> variables;
  Objective objective;
  std::vector<Constraint> constraints;
  std::vector<Finger> population;  // empty: the design's finger alone
  std::vector<Scenario> scenarios;
  std::vector<Scatter> scatter;
  StudyRisk risk;
  std::vector<ScatterCorrelation> correlations;  // of the scatter
  Search search;
  // Of a base's space and scatter, what goes with its kind of texture: "design_space.texture.rms".
  std::vector<std::string> fallen_away;
  // What it says of its own [finger] and no finger of the population has: "finger.skin.rms".
  std::vector<std::string> unheard;

  std::string file;     // as given
  std::string name;     // of the results folder: the file's stem, or its folder's for study.toml
  Origins origins;      // of every value that was read
  Node study_sections;  // the study's own sections as read, for resolved.toml

  bool is_study() const { return !variables.empty(); }
};

// The scenarios that count and set this number, under its own key or another kind's.
std::vector<std::string> scenarios_setting(const Study& study, const std::string& path);

// What of the study's files a search does not use, or what it asks for and no design changes, a
// line each.
std::vector<std::string> unused_of(const Study& study);

// Throws InputError with every mistake.
Study read_study(const std::string& path, const std::vector<std::string>& overrides = {},
                 DesignUse use = DesignUse::Simulated);
// From text in place of a file; `name` stands for it in messages. Files that it names are looked
// for in the folder where the program runs, and bases in the designs folders too.
Study parse_study(const std::string& text, const std::string& name,
                  const std::vector<std::string>& overrides = {},
                  DesignUse use = DesignUse::Simulated);
// Every value of the study with its origin; reads back to the same study.
std::string resolved_toml(const Study& study);

// A variable's value as people write it: "3.2 um", "hole_array"; plain: without the unit.
std::string variable_text(const Variable& variable, double value, bool plain = false);

}  // namespace papilla::design
