#include "estimate/evaluation.h"

#include <set>

#include "base/error.h"
#include "estimate/belief.h"
#include "estimate/parameters.h"
#include "estimate/target.h"
#include "estimate/voltage.h"
#include "forward/pull_in.h"

namespace papilla::estimate {

Response evaluate_design(const Design& design, const EvaluationOptions& options) {
  const Scene scene = scene_of(design);
  Fidelity fidelity = options.fidelity.value_or(fidelity_of(design));
  fidelity.threads = options.threads;
  const double target = options.fidelity     ? 0
                        : options.target > 0 ? options.target
                                             : design.accuracy.target;
  Response response = target > 0 ? evaluate_to_target(scene, design.texture,
                                                      {.target = target,
                                                       .seed = fidelity.seed,
                                                       .droplet_seeds = fidelity.droplet_seeds,
                                                       .threads = options.threads})
                                 : evaluate(scene, design.texture, fidelity);
  set_bridged_margins(response, scene, design.texture);
  if (options.model) add_belief(response, scene, design.texture, response.fidelity);
  // No uncertainty is counted twice: belief holds what the fit of the finger leaves open.
  if ((options.parameters || design.accuracy.parameters) && response.belief.members.empty())
    add_parameter_errors(response, scene, design.texture, response.fidelity);
  if (options.appearance) response.appearance = appearance_of(design);
  if (options.pull_in) add_pull_in(response, scene, design.texture, fidelity);
  if (!options.voltage_for.empty())
    add_voltages(response, scene, design.texture, fidelity, options.voltage_for);
  return response;
}

void add_pull_in(Response& response, const Scene& scene, const Texture& texture,
                 const Fidelity& fidelity) {
  if (!response.driven) return;
  for (ResponsePoint& point : response.points)
    point.pull_in = pull_in(scene, texture, fidelity, point.relative_humidity);
}

void require_fitted_model(const Design& design, const std::string& file,
                          const std::string& way_out) {
  require_fitted_model(std::vector{design}, file, way_out);
}

void require_fitted_model(const std::vector<Design>& designs, const std::string& file,
                          const std::string& way_out) {
  std::vector<Problem> problems;
  std::set<std::string> told;
  for (const Design& design : designs) {
    for (const std::string& line : calibration_mismatch(design))
      if (told.insert(line).second) problems.push_back({file, 0, 0, "", line});
  }
  if (problems.empty()) return;
  problems.push_back({"", 0, 0, "",
                      "such a change moves the modulation by tens of percent; fit the finger "
                      "again, or " +
                          way_out});
  throw InputError(problems);
}

}  // namespace papilla::estimate
