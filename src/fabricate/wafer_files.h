// A wafer as a folder: layouts, the designs, what to measure where; and whether they are right.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/constants.h"
#include "base/rooms.h"
#include "fabricate/made.h"
#include "fabricate/verify.h"
#include "fabricate/wafer_drawing.h"

namespace papilla::fabricate {

inline constexpr const char* kWaferRecord = "wafer.toml";
inline constexpr const char* kManifest = "manifest.csv";

// What the model says of a design under one condition; NaN where it says nothing.
struct Expected {
  double modulation = 0, modulation_error = 0;  // of undriven conditions nothing
  double friction_off = 0, friction_error = 0;  // [N]
  // Strength over field of the film: the field that was solved, and that under a bridge or a
  // contact on its thinnest place; infinite without a field.
  double oxide_margin = kInfinity, bridged_margin = kInfinity;
};
// [treatment][condition], in the order of conditions_of. Draft level; each design once per load,
// state, voltage and frequency. model: the errors hold what is not known of finger and model.
using Expectations = std::vector<std::vector<Expected>>;
Expectations expect(const WaferPlan& plan, bool model, const FileProgress& progress = {});

// Throws InputError for each condition under which the model refuses a design: no film under a
// voltage, more of it than the source has, a pin that flows under the load. use: whether what is
// expected there is worked out too.
void check_conditions(const WaferPlan& plan, DesignUse use = DesignUse::Simulated);

// Voltages under which a film breaks down, of which nothing is expected, or is at risk under a
// bridge or a contact; a line a design and voltage.
std::vector<std::string> breakdown_lines(const WaferPlan& plan, const Expectations& expected);

// Writes wafer.gds, wafer.oas, manifest.csv, wafer.toml and designs/NAME.toml into a folder, which
// is made. Without expectations the manifest has no columns of them. Paths of what was written.
std::vector<std::string> write_wafer(const WaferPlan& plan, const WaferDrawing& drawing,
                                     const Expectations& expected, const std::string& folder);

// Whether a folder holds a wafer.
bool holds_wafer(const std::string& folder);

// What comes out of a drawn array.
struct WaferMade {
  std::string design, cell;
  MadeArray made;
};

struct WaferVerdict {
  std::vector<FileVerdict> files;
  std::vector<WaferMade> made;  // of the polygons in wafer.gds
};
// Every file of a wafer's folder against what its record makes, and the surfaces that the process
// makes of its polygons. Throws InputError where it has no record.
WaferVerdict verify_wafer(const std::string& folder, const FileProgress& progress = {});

// The surfaces that the process makes of a drawing.
std::vector<WaferMade> made_of_wafer(const WaferDrawing& drawing, const Layout& layout,
                                     const Process& process);

}  // namespace papilla::fabricate
