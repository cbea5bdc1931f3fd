// The forward model: friction of a finger on a texture, off and on, over humidity.
#pragma once

#include <functional>
#include <memory>

#include "forward/coupling.h"
#include "forward/fidelity.h"
#include "forward/response.h"
#include "forward/scale_bridge.h"
#include "geometry/texture.h"
#include "scene/scene.h"

namespace papilla {

// Errors of every quantity at each humidity by one origin, measured on the control skins.
struct MeasuredError {
  std::optional<double> ErrorParts::*origin = nullptr;
  std::vector<std::array<double, kMeasured.size()>> size;  // [humidity][quantity], relative
  int contact_solves = 0;
  double fft_pairs = 0, seconds = 0;
  std::vector<ModelStatus> pull_in{};  // [humidity] of solved areas, where the load law sees none
};

// The solved patches of a scene: what a Response is made of. More skins can be added later.
struct PatchSet {
  Plan plan;
  std::vector<ScaleBridge> bridges;               // one a humidity
  std::vector<std::vector<PatchResult>> results;  // [humidity][skin]
  std::vector<MeasuredError> errors;              // of measure_errors, like the next
  ControlRuns controls;
  double seconds = 0;  // wall time

  int skins() const { return results.empty() ? 0 : static_cast<int>(results.front().size()); }
  void add(const PatchSet& other);  // the same scene, other skins
};

// Skins first_skin ... first_skin + skins - 1 of the fidelity, at each humidity. Parallel over
// skins; the same bytes for any number of threads. Cost: skins x humidities x (1 or 3) contact
// solves.
PatchSet solve_patches(const Scene& scene, const Texture& texture, const Fidelity& fidelity);

// Fills patches.errors and patches.controls, the grid and method parts of the error, from
// fidelity.control_skins of the patches run again: on half the pixels (Eq. accuracy.2), and with
// contact areas solved in place of the load law (Eq. accuracy.3). Nothing with fewer than two
// control skins.
void measure_errors(const Scene& scene, const Texture& texture, const Fidelity& fidelity,
                    PatchSet& patches);

// Friction, modulation and their causes at each humidity, of all skins and without each.
Response respond(const Scene& scene, const Fidelity& fidelity, const PatchSet& patches);

// A number read off the points of a response; nothing where it is not defined.
using Reading = std::function<std::optional<double>(const std::vector<ResponsePoint>&)>;

// What grid and load law do to a number that stands on a quantity, relative to it, as samples of
// the control skins: Eq. accuracy.2, accuracy.3. Empty where they were not run or the number is not
// defined.
struct ControlledChange {
  std::vector<double> grid, method;
};
ControlledChange controlled_change(const ControlRuns& runs, Measured ResponsePoint::*quantity,
                                   const Reading& number);
// The errors that they state: the scatter between skins is added, of the load law taken off. 0 for
// no samples.
double grid_error(const std::vector<double>& samples);
double method_error(const std::vector<double>& samples);

// All three: friction, modulation and their causes with their errors at each humidity.
Response evaluate(const Scene& scene, const Texture& texture, const Fidelity& fidelity);

// The patches of one humidity before the drive, to be driven at one voltage after another: contact
// and water at rest are solved once. Memory: 32 bytes a pixel, skin and patch pressure.
class RestPatches {
 public:
  // scene: of one humidity; its amplitude does not matter.
  RestPatches(const Scene& scene, const Texture& texture, const Fidelity& fidelity);

  // The response at an amplitude [V] > 0. The load estimator costs field and water alone, the area
  // one a contact solve a patch.
  ResponsePoint drive(double amplitude, Estimator estimator) const;

 private:
  Scene scene_;
  Fidelity fidelity_;
  Plan plan_;
  std::unique_ptr<const CoveredSurface> surface_;
  std::shared_ptr<const ContactKernel> kernel_;
  std::vector<double> pressures_;
  std::vector<std::vector<double>> height_;   // one a skin
  std::vector<std::vector<RestPatch>> rest_;  // [skin][pressure x water member]
};

// One patch with all its fields, for pictures: skin `index` of the fidelity at one humidity.
struct PatchPicture {
  Heightmap texture, skin;
  PatchFields fields;
};
PatchPicture picture_patch(const Scene& scene, const Texture& texture, const Fidelity& fidelity,
                           double relative_humidity, int index = 0);

}  // namespace papilla
