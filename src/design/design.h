// A design (what to make and where it is felt) and a study (a design, what may change, what is
// wanted). Read from TOML with every problem at once, written back with the origin of each value.
#pragma once

#include <string>
#include <vector>

#include "config/node.h"
#include "config/reader.h"
#include "forward/appearance.h"
#include "forward/fidelity.h"
#include "geometry/texture.h"
#include "scene/environment.h"
#include "scene/finger.h"
#include "scene/scene.h"
#include "scene/view.h"

namespace papilla {

enum class AccuracyLevel { Draft, Design, Reference };
const std::vector<std::string>& accuracy_level_names();

struct AccuracySettings {
  AccuracyLevel level = AccuracyLevel::Design;
  int grid = 0;       // pixels along the window; 0: by level
  double target = 0;  // wanted standard error of the modulation, as a share of it; 0: by level
  bool parameters = false;  // evaluate: also what the finger's fitted numbers leave open
  int seed = 1;             // of skins, offsets and droplets, common to all designs
  int droplet_seeds = 1;    // placements of the droplets on each skin, averaged; the M3 paper: 6

  std::string level_name() const;
  bool operator==(const AccuracySettings&) const = default;
};
void fields(FieldVisitor& v, AccuracySettings& s);

struct Design {
  int schema_version = 1;
  std::string title;
  Texture texture;
  Surface surface;
  View view;
  Finger finger;
  Environment environment;
  Drive drive;
  ModelOptions model;  // starts from finger.calibrated_for
  AccuracySettings accuracy;

  bool operator==(const Design&) const = default;
};
void fields(FieldVisitor& v, Design& s);

// What the forward model takes.
Scene scene_of(const Design& design);
Fidelity fidelity_of(const Design& design);
Optics appearance_of(const Design& design);

// Model options that differ from those the finger was fitted with, one line each. They shift the
// modulation by tens of percent: running so needs the user's word.
std::vector<std::string> calibration_mismatch(const Design& design);

// A mistake across fields, at the path of the value to change.
struct DesignProblem {
  std::string path, message;
};
std::vector<DesignProblem> design_problems(const Design& design);

// One number that the search may change; or the texture's kind ("texture.type", by its place in
// texture_kinds()) or how many parts of a stack there are ("texture.levels").
struct Variable {
  std::string path;             // into Design: "texture.diameter"
  std::string unit;             // for people
  double low = 0, high = 0;     // SI
  std::vector<double> choices;  // SI; when not empty, one of these

  bool is_kind() const { return path == "texture.type"; }
  bool is_levels() const { return path == "texture.levels"; }

  bool operator==(const Variable&) const = default;
};

// What a metric should be at every humidity.
struct Target {
  std::string metric;
  double value = 0;  // SI

  bool operator==(const Target&) const = default;
};

// Metric expressions such as "mean(modulation)"; two objectives make a Pareto front.
struct Objective {
  std::vector<std::string> maximise, minimise;
  std::vector<Target> targets;  // the root mean square distance from each is minimised
  std::string risk;  // "mean - 2 std", "cvar 20 %", "worst"; "": mean over the population

  bool operator==(const Objective&) const = default;
};

struct ConstraintKind {
  std::string name, unit;
  bool at_least = true;  // else at most
  std::string doc;
};
const std::vector<ConstraintKind>& constraint_kinds();

struct Constraint {
  std::string name;
  double limit = 0;  // SI
  bool at_least = true;

  bool operator==(const Constraint&) const = default;
};

struct Setting {
  std::string path;
  double value = 0;  // SI

  bool operator==(const Setting&) const = default;
};

// A state of the product that counts beside the others: new, worn.
struct Scenario {
  std::string name;
  double weight = 1;
  std::vector<Setting> set;  // numbers of the design that this scenario fixes

  bool operator==(const Scenario&) const = default;
};

// How far fabrication may miss a number of the design: anywhere within +- tolerance.
struct Scatter {
  std::string path;
  double tolerance = 0;  // SI

  bool operator==(const Scatter&) const = default;
};

struct Search {
  std::string method = "auto";
  int seed = 1;
  int evaluations = 0;  // 0: as many as the time allows, or the method's default
  int drafts = 0;       // besides; of the Gaussian process alone
  double time = 0;      // wall clock [s]; 0: no limit
  int jobs = 0;         // 0: all processors

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
  Search search;

  std::string file;     // as given
  std::string name;     // of the results folder: the file's stem, or its folder's for study.toml
  Origins origins;      // of every value that was read
  Node study_sections;  // the study's own sections as read, for resolved.toml

  bool is_study() const { return !variables.empty(); }
};

// Where `base` files are looked for besides the user's own folder: $PAPILLA_DESIGNS, the source
// tree's and the installed designs folder, those that exist.
std::vector<std::string> design_roots();
// The file below the first of those folders that has it; throws InputError.
std::string find_design(const std::string& name);

// Throws InputError with every problem. A study file is a design too.
Design read_design(const std::string& path, const std::vector<std::string>& overrides = {});
Study read_study(const std::string& path, const std::vector<std::string>& overrides = {});
Finger read_finger(const std::string& path);

void write_design(const std::string& path, const Design& design);
void write_finger(const std::string& path, const Finger& finger, const std::string& comment = "");
// Every value of the study with its origin; reads back to the same study.
std::string resolved_toml(const Study& study);

// The design with numbers changed by path (SI). Numbers of the texture that its kind does not have
// are left out.
Design with_settings(Design design, const std::vector<Setting>& settings);

// A variable's value as people write it: "3.2 um", "hole_array"; plain: without the unit.
std::string variable_text(const Variable& variable, double value, bool plain = false);

}  // namespace papilla
