#include "papilla/evaluate.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "api/inside.h"
#include "estimate/evaluation.h"
#include "report/response.h"

namespace papilla::api {
namespace {

constexpr int kMostThreads = 4096;

Quantity quantity_of(const Measured& m) {
  return {m.value,
          m.se(),
          {m.parts.sampling, m.parts.grid, m.parts.solver, m.parts.humidity, m.parts.method,
           m.parts.field, m.parts.parameters, m.parts.model, m.parts.water},
          m.parts.numerical(),
          m.parts.model_part()};
}

Quantity no_quantity() {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  Quantity out;
  out.value = out.error = out.parts.sampling = out.numerical = kNone;
  return out;
}

Point point_of(const ResponsePoint& p, bool driven) {
  Point out;
  out.relative_humidity = p.relative_humidity;
  for (std::size_t k = 0; k < kQuantities<Quantity>.size(); ++k) {
    const auto& row = kQuantities<Measured>[k];
    out.*kQuantities<Quantity>[k].value =
        exists(row.drive, p, driven) ? quantity_of(p.*row.value) : no_quantity();
  }
  out.sound = p.said().sound();
  out.status = text(p.said());
  return out;
}

rooms::Design at_level(rooms::Design design, const std::string& level) {
  const std::vector<std::string>& names = accuracy_level_names();
  const auto found = std::find(names.begin(), names.end(), level);
  if (found == names.end())
    throw wrong("level", "expected draft, design or reference, got \"" + level + "\"");
  design.accuracy.level = static_cast<AccuracyLevel>(found - names.begin());
  design.accuracy.target = 0;
  return design;
}

}  // namespace

Response::Response(std::shared_ptr<const Inside> inside) : inside_(std::move(inside)) {}

const std::vector<Point>& Response::points() const { return inside_->points; }

bool Response::driven() const { return inside_->response.driven; }

std::string Response::trouble() const { return text(inside_->response.said()); }

std::string Response::json(bool with_time) const {
  return response_json(inside_->response, with_time);
}

std::string Response::svg(const std::string& title) const {
  return response_svg(inside_->response, title);
}

std::string Response::table() const { return response_table(inside_->response); }

void require_threads(int threads) {
  if (threads < 0 || threads > kMostThreads) {
    throw wrong("threads",
                fmt::format("expected 0, all processors, to {}, got {}", kMostThreads, threads));
  }
}

rooms::Design at_options(const Design& design, const EvaluateOptions& options) {
  const rooms::Design& own = design.inside().design();
  require_threads(options.threads);
  design.require_simulated();
  if (!options.force) require_fitted_model(own, design.inside().file, "set `force`");
  if (!(options.target >= 0 && options.target < 1))
    throw wrong("target", "expected a share from 0 to 1");
  if (!options.level.empty() && options.target > 0)
    throw wrong("target", "give a level or a target, not both: a target finds its own level");
  for (const double modulation : options.voltage_for) {
    if (!(modulation > 0 && std::isfinite(modulation))) {
      throw wrong("voltage_for",
                  fmt::format("expected modulations above 0, 0.3 is 30 %; got {}", modulation));
    }
  }
  return options.level.empty() ? own : at_level(own, options.level);
}

Response evaluated(const rooms::Design& design, const EvaluateOptions& options,
                   const std::optional<Fidelity>& fidelity) {
  Watch watch(options.progress, options.stop);
  Response::Inside inside;
  inside.response = evaluate_design(design, {.target = options.target,
                                             .fidelity = fidelity,
                                             .model = options.model,
                                             .parameters = options.parameters,
                                             .appearance = options.look,
                                             .voltage_for = options.voltage_for,
                                             .threads = options.threads});
  for (const ResponsePoint& p : inside.response.points)
    inside.points.push_back(point_of(p, inside.response.driven));
  return Response(std::make_shared<const Response::Inside>(std::move(inside)));
}

Response evaluate(const Design& design, const EvaluateOptions& options) {
  return across([&] { return evaluated(at_options(design, options), options); });
}

}  // namespace papilla::api
