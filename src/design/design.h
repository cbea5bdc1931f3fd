// A design: what to make and where it is felt. Read from TOML with every mistake at once.
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"
#include "config/fields.h"
#include "forward/appearance.h"
#include "forward/fidelity.h"
#include "geometry/texture.h"
#include "scene/counterface.h"
#include "scene/environment.h"
#include "scene/finger.h"
#include "scene/scene.h"
#include "scene/view.h"

namespace papilla::design {

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
  Counterface counterface;
  Environment environment;
  Drive drive;
  ModelOptions model = Finger{}.calibrated_for;  // starts from finger.calibrated_for
  AccuracySettings accuracy;

  bool operator==(const Design&) const = default;
};
void fields(FieldVisitor& v, Design& s);

// What the forward model takes: touched by the design's finger or by what stands in its place.
Scene scene_of(const Design& design);
// The design under its pen.
Design under_pen(Design design);
Fidelity fidelity_of(const Design& design);
Optics appearance_of(const Design& design);

// Model options that differ from those the finger was fitted with, one line each. They shift the
// modulation by tens of percent: running so needs the user's word.
std::vector<std::string> calibration_mismatch(const Design& design);

// A mistake across fields, at the path of the value to change.
struct DesignProblem {
  std::string path, message;
};
// What a design is read for: to be simulated, or to be drawn into files alone, for which it may
// have a patch that no simulation settles.
enum class DesignUse { Simulated, Drawn };
std::vector<DesignProblem> design_problems(const Design& design,
                                           DesignUse use = DesignUse::Simulated);

// Where `base` files are looked for besides the user's own folder: $PAPILLA_DESIGNS, the source
// tree's and the installed designs folder, those that exist.
std::vector<std::string> design_roots();
// The file below the first of those folders that has it; throws InputError.
std::string find_design(const std::string& name);

// The file, or the one of that name in those folders where there is none: designs, studies and
// cases are named so in every door.
std::string own_or_shipped(const std::string& file);

// The measured maps that a design names, where they stand in it: of its texture, its skin, the pin
// and the pen.
std::vector<std::string*> map_files(Design& design);

// For the keys of work on disk that stands on them: which versions of its maps a design or a finger
// is of, and what the designs of a folder below those say, each as it resolves here and now. Those
// that do not read are left out.
std::string maps_state(Design design);
std::string maps_state(const Finger& finger);
std::string designs_state(const std::string& folder);

// Throws InputError with every mistake. A study file is a design too.
Design read_design(const std::string& path, const std::vector<std::string>& overrides = {});
Finger read_finger(const std::string& path);

void write_design(const std::string& path, const Design& design);
void write_finger(const std::string& path, const Finger& finger, const std::string& comment = "");

}  // namespace papilla::design
