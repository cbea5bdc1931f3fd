#include "papilla/differences.h"

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
    Comparison out{evaluate(first, both), evaluate(second, both), {}, {}, {}};
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
    // At its own target each end would choose its own grid and skins.
    const rooms::Design own = at_options(design, common(options.evaluate, design));
    Watch watch(options.evaluate.progress, options.evaluate.stop);
    std::vector<Sensitivity> out;
    for (const std::string& key : options.keys.empty() ? texture_numbers(own) : options.keys) {
      const DesignStep step = design_step(own, key, options.step);
      if (!step.moves()) continue;
      const EvaluationOptions how{.target = options.evaluate.target,
                                  .model = false,
                                  .parameters = false,
                                  .appearance = false,
                                  .voltage_for = {},
                                  .threads = options.evaluate.threads};
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
