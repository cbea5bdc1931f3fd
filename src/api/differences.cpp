#include "papilla/differences.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "api/inside.h"
#include "estimate/difference.h"
#include "estimate/evaluation.h"

namespace papilla::api {
namespace {

Difference difference_of(const ResponseDifference& d) {
  Difference out{d.value, d.error, d.paired, {}, {}};
  if (d.model) {
    out.model = d.model->deviation;
    out.above = d.model->above;
  }
  return out;
}

// Compared designs share their level: the first one's own where none is asked for.
EvaluateOptions common(EvaluateOptions options, const Design& design) {
  if (options.level.empty() && options.target == 0)
    options.level = design.inside().design().accuracy.level_name();
  return options;
}

// Enough for both.
Fidelity finer(const Fidelity& a, const Fidelity& b) {
  Fidelity out = a;
  out.grid = std::max(a.grid, b.grid);
  out.skins = std::max(a.skins, b.skins);
  if (b.estimator == Estimator::Area) out.estimator = Estimator::Area;
  return out;
}

// Both on the skins, droplets and grids of the first; of a target on those of the one that needs
// more.
std::pair<Response, Response> on_common_skins(const rooms::Design& first, rooms::Design second,
                                              const EvaluateOptions& options) {
  second.accuracy.grid = first.accuracy.grid;
  second.accuracy.seed = first.accuracy.seed;
  second.accuracy.droplet_seeds = first.accuracy.droplet_seeds;
  std::pair<Response, Response> out{evaluated(first, options), evaluated(second, options)};
  const auto fidelity = [](const Response& r) { return r.inside().response.fidelity; };
  const Fidelity both = finer(fidelity(out.first), fidelity(out.second));
  if (fidelity(out.first) != both) out.first = evaluated(first, options, both);
  if (fidelity(out.second) != both) out.second = evaluated(second, options, both);
  return out;
}

rooms::Design moved(rooms::Design design, const std::string& path, double value) {
  set_number(design, path, value);
  return design;
}

}  // namespace

Comparison compare(const Design& first, const Design& second, const EvaluateOptions& options) {
  return across([&] {
    if (first.inside().design().environment != second.inside().design().environment) {
      throw wrong("environment.relative_humidity", "compared designs meet the same humidities");
    }
    const EvaluateOptions both = common(options, first);
    auto [of_first, of_second] =
        on_common_skins(at_options(first, both), at_options(second, both), both);
    Comparison out{std::move(of_first), std::move(of_second), {}, {}, {}};
    const rooms::Response &a = out.first.inside().response, &b = out.second.inside().response;
    const bool driven = a.driven && b.driven;
    for (std::size_t i = 0; i < a.points.size(); ++i) {
      ComparedPoint p;
      p.relative_humidity = a.points[i].relative_humidity;
      p.friction_off = difference_of(difference_at(i, kFriction, a, b));
      if (driven) {
        p.modulation = difference_of(difference_at(i, kModulation, a, b));
        p.friction_on = difference_of(difference_at(i, kFrictionOn, a, b));
      }
      out.points.push_back(p);
    }
    out.mean_friction = difference_of(rooms::difference_of({Summary::Mean, kFriction}, a, b));
    if (driven)
      out.mean_modulation = difference_of(rooms::difference_of({Summary::Mean, kModulation}, a, b));
    return out;
  });
}

std::vector<Sensitivity> sensitivity(const Design& design, const std::string& metric,
                                     const SensitivityOptions& options) {
  return across([&] {
    if (!(options.step > 0 && options.step < 1))
      throw wrong("step", "expected more than 0 and less than 1");
    const MetricExpression expression = parse_own_metric(metric);
    const rooms::Design own = at_options(design, common(options.evaluate, design));
    Watch watch(options.evaluate.progress, options.evaluate.stop);
    EvaluationOptions how{.target = options.evaluate.target,
                          .fidelity = {},
                          .model = false,
                          .parameters = false,
                          .appearance = false,
                          .voltage_for = {},
                          .threads = options.evaluate.threads};
    // To a target each end would take a grid and skins of its own: both take the design's.
    if (how.target > 0) how.fidelity = evaluate_design(own, how).fidelity;
    std::vector<Sensitivity> out;
    for (const std::string& key : options.keys.empty() ? texture_numbers(own) : options.keys) {
      const DesignStep step = design_step(own, key, options.step);
      if (!step.moves()) continue;
      const ResponseDifference change =
          rooms::difference_of(expression, evaluate_design(moved(own, step.path, step.down), how),
                               evaluate_design(moved(own, step.path, step.up), how));
      const double length = step.up - step.down;
      out.push_back({step.path, step.unit, step.value, step.down, step.up, difference_of(change),
                     change.value / length, change.error / length});
    }
    return out;
  });
}

}  // namespace papilla::api
