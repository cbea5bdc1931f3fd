#include "estimate/parameters.h"

#include <algorithm>
#include <cmath>

#include "metrics/metrics.h"

namespace papilla::estimate {
namespace {

// Differences on common skins scatter far less than values: a few skins on few pixels are enough.
constexpr int kMostSkins = 8, kFinestGrid = 128;
constexpr double kStepTolerance = 1e-3;  // of the contact, at the finest

}  // namespace

Fidelity step_fidelity(const Fidelity& fidelity) {
  Fidelity few = fidelity;
  few.skins = std::min(fidelity.skins, kMostSkins);
  few.grid = std::min(fidelity.grid, kFinestGrid);
  few.contact_tolerance = std::max(fidelity.contact_tolerance, kStepTolerance);
  few.estimator = Estimator::Load;
  few.control_skins = 0;
  few.field_skins = 0;
  return few;
}

void take_felt_errors(Resampled& run, const std::vector<ResponsePoint>& response) {
  const auto take = [&](std::vector<ResponsePoint>& points) {
    for (std::size_t i = 0; i < std::min(points.size(), response.size()); ++i) {
      const Measured& known = response[i].modulation;
      points[i].felt_error = known.parts.numerical() / (1 + known.value);
    }
  };
  take(run.points);
  for (std::vector<ResponsePoint>& points : run.without) take(points);
}

void add_parameter_errors(Response& response, const Scene& scene, const Texture& texture,
                          const Fidelity& fidelity) {
  const std::vector<FingerStep> steps = finger_steps(scene.finger);
  const Fidelity few = step_fidelity(fidelity);
  ParameterSteps& out = response.parameters;
  out = {{}, few.skins, few.grid, {}};
  const auto run = [&](const Finger& finger) -> Resampled {
    Scene moved = scene;
    moved.finger = finger;
    const PatchSet patches = solve_patches(moved, texture, few);
    Response there = respond(moved, few, patches);
    if (out.troubles.empty()) out.troubles = there.troubles();
    response.seconds += there.seconds;
    response.contact_solves += there.contact_solves;
    response.fft_pairs += there.fft_pairs;
    return there;
  };
  for (const FingerStep& step : steps) out.steps.push_back({run(step.up), run(step.down)});
  for (std::size_t i = 0; i < response.points.size(); ++i) {
    for (const PointQuantity& quantity : kPointQuantities) {
      const auto value = [&](const std::vector<ResponsePoint>& points) {
        return std::optional((points[i].*quantity.value).value);
      };
      (response.points[i].*quantity.value).parts.parameters =
          step_error(*step_samples(out.steps, value));
    }
  }
  for (ParameterStep& step : out.steps) {
    take_felt_errors(step.up, response.points);
    take_felt_errors(step.down, response.points);
  }
}

}  // namespace papilla::estimate
