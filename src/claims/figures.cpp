#include "claims/figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "claims/members.h"
#include "claims/papers.h"
#include "forward/forward.h"
#include "forward/scene_terms.h"
#include "published/samples.h"
#include "published/targets.h"
#include "published/whole_finger.h"

namespace papilla::claims {
namespace {

// 5 to 10 um3 at 75 % RH; the volumes at other humidities are in a supplement that is not to be
// had, so they take the same shares of the mean.
constexpr double kVolumes[] = {2.0 / 3, 4.0 / 3};

// Of the printed numbers at a member of the belief.
const SkinSampling kMemberSampling{"draft", 8, 0, 0};

struct Shown {
  std::string figures, sample;
  SampleCase of;
};

std::vector<Shown> shown_cases() {
  std::vector<Shown> out;
  for (const std::string& name : m3_sample_names())
    out.push_back({"2d,e 3d-f", name, m3_case(name)});
  for (const char* name : {"flat", "a3h350"})
    out.push_back({"4d,e", fmt::format("{} 110°", name), m3_case(name, 110)});
  for (const FingerState state : {FingerState::Clean, FingerState::Natural}) {
    for (const char* size : {"large", "small"}) {
      for (int region = 1; region <= 3; ++region) {
        out.push_back(
            {"4a",
             fmt::format("{} film {}", size, region),
             {.design = fmt::format("coatings/hdpe_{}_{}.toml", size, region), .state = state}});
      }
    }
  }
  return out;
}

// Over volumes on the same skins, so that their errors are one.
FigureValue over_volumes(const std::vector<Estimate>& values) {
  FigureValue out{{}, kInfinity, -kInfinity};
  for (const Estimate& e : values) {
    out.value.value += e.value / static_cast<double>(values.size());
    out.value.se += e.se / static_cast<double>(values.size());
    out.low = std::min(out.low, e.value);
    out.high = std::max(out.high, e.value);
  }
  return out;
}

FigureRow row_at(const Shown& shown, const std::vector<Scene>& scenes,
                 const std::vector<Response>& responses, std::size_t rh) {
  const auto value = [&](auto&& quantity) {
    std::vector<Estimate> values;
    for (std::size_t i = 0; i < responses.size(); ++i)
      values.push_back(quantity(scenes[i], responses[i], responses[i].points[rh]));
    return over_volumes(values);
  };
  const auto measured = [&](Measured PointQuantities::*member, auto&& scale) {
    return value([&](const Scene& scene, const Response& r, const ResponsePoint& p) {
      const double factor = scale(scene, r, p);
      return Estimate{factor * (p.*member).value, factor * (p.*member).parts.sampling};
    });
  };
  const auto whole = [](const Scene&, const Response&, const ResponsePoint&) { return 1.0; };
  const auto of_patch = [](const Scene& s, const Response& r, const ResponsePoint& p) {
    return p.patch_pressure * r.plan.grid.area() / s.finger.load;
  };
  FigureRow row{shown.figures,
                shown.sample,
                finger_state_names()[static_cast<std::size_t>(shown.of.state)],
                scenes[0].model.preset,
                responses[0].points[rh].relative_humidity,
                measured(&PointQuantities::friction_off, whole),
                measured(&PointQuantities::friction_on, whole),
                {},
                measured(&PointQuantities::modulation, whole),
                measured(&PointQuantities::capillary_force, of_patch),
                measured(&PointQuantities::electrostatic_force, of_patch),
                measured(&PointQuantities::area_fraction_off,
                         [](const Scene& s, const Response&, const ResponsePoint& p) {
                           return p.strength / shear_strength(in_its_state(s), p.relative_humidity);
                         })};
  row.effect = value([&](const Scene&, const Response& r, const ResponsePoint& p) {
    const auto of = [](const ResponsePoint& q) {
      return q.friction_on.value - q.friction_off.value;
    };
    std::vector<double> without;
    for (const std::vector<ResponsePoint>& points : r.without) without.push_back(of(points[rh]));
    return mean_estimate(jackknife_samples(of(p), without));
  });
  return row;
}

void add_rows(FingerModel& model, const Shown& shown, std::vector<FigureRow>& rows) {
  const Design design = read_case(shown.of);
  const Fidelity fidelity = [&] {
    Fidelity f = model.fidelity();
    f.droplet_seeds = kPlacements;
    return f;
  }();
  std::vector<Scene> scenes;
  std::vector<Response> responses;
  for (const double factor : kVolumes) {
    Scene scene = scene_of(model, shown.of, design);
    for (double& volume : scene.finger.water.volume) volume *= factor;
    responses.push_back(evaluate(scene, design.texture, fidelity));
    scenes.push_back(std::move(scene));
  }
  for (std::size_t rh = 0; rh < responses[0].points.size(); ++rh)
    rows.push_back(row_at(shown, scenes, responses, rh));
}

// "27.3 % (flat) to 6.7 % (structured)", by the reading that is nearest (M14).
Estimate variation(FingerModel& model, const char* sample, double angle) {
  const Sample& s = m3_sample(model, sample, angle);
  return jackknife(model, [&](Skins over) { return 100 * deviation_over_mean(s, over); });
}

std::vector<PublishedTarget> printed_numbers() {
  std::vector<PublishedTarget> out;
  for (PublishedTarget& target : published_targets()) {
    // Trends have no number.
    if (std::isfinite(target.low) && std::isfinite(target.high) && target.claim != "M10")
      out.push_back(std::move(target));
  }
  out.push_back({"M14", "sd/mean of the modulation over humidity, flat 50°, %", 27.3, 27.3, 5,
                 [](FingerModel& model) { return variation(model, "flat", 0); }});
  out.push_back({"M14", "sd/mean of the modulation over humidity, a3h350 110°, %", 6.7, 6.7, 5,
                 [](FingerModel& model) { return variation(model, "a3h350", 110); }});
  for (PublishedTarget& target : whole_finger_targets()) out.push_back(std::move(target));
  return out;
}

ParameterSet set_of(std::string name, const std::vector<PrintedNumber>& printed,
                    std::vector<double> values) {
  ParameterSet out{std::move(name), std::move(values), {}};
  for (std::size_t i = 0; i < printed.size(); ++i) {
    const PrintedNumber& p = printed[i];
    const double error = out.values[i] - std::clamp(out.values[i], p.low, p.high);
    out.misses.push_back(error / std::hypot(p.papilla.se, p.published_sd));
  }
  return out;
}

// Of each hypothesis the member that comes nearest to all of them.
void add_nearest(FigureTables& tables, const Belief& belief,
                 const std::vector<std::vector<double>>& values) {
  const std::size_t own = tables.sets.size();
  for (std::size_t k = 0; k < belief.members.size(); ++k) {
    std::vector<double> there;
    for (const std::vector<double>& of : values) there.push_back(of[k]);
    ParameterSet set = set_of(belief.members[k].hypothesis, tables.printed, std::move(there));
    const auto same =
        std::find_if(tables.sets.begin() + static_cast<std::ptrdiff_t>(own), tables.sets.end(),
                     [&](const ParameterSet& other) { return other.name == set.name; });
    if (same == tables.sets.end())
      tables.sets.push_back(std::move(set));
    else if (set.largest() < same->largest())
      *same = std::move(set);
  }
}

// What belief leaves of each number: its spread over the members, on the skins of a draft.
void add_input_errors(FigureTables& tables, const std::vector<PublishedTarget>& targets,
                      const FigureOptions& options) {
  if (options.finger.belief.empty()) return;
  std::vector<PrintedNumber>& printed = tables.printed;
  const Belief belief = belief_of(options.finger);
  std::vector<double> weights;
  std::vector<std::vector<double>> values(printed.size());
  for (std::size_t k = 0; k < belief.members.size(); ++k) {
    if (options.started)
      options.started(fmt::format("belief, member {} of {}", k + 1, belief.members.size()));
    FingerModel model(member_finger(belief, belief.members[k], options.finger), Preset::Papilla,
                      options.threads, kMemberSampling);
    weights.push_back(belief.members[k].weight);
    for (std::size_t i = 0; i < printed.size(); ++i)
      values[i].push_back(targets[i].model(model).value);
  }
  for (std::size_t i = 0; i < printed.size(); ++i)
    printed[i].input_sd = deviation_over(weights, values[i]);
  add_nearest(tables, belief, values);
}

}  // namespace

double PrintedNumber::deviation(const Estimate& model) const {
  const double nearest = std::clamp(model.value, low, high);
  return model.value / nearest - 1;
}

double ParameterSet::largest() const {
  double out = 0;
  for (const double miss : misses) out = std::max(out, std::abs(miss));
  return out;
}

double PrintedNumber::error() const { return papilla.value - std::clamp(papilla.value, low, high); }

double PrintedNumber::validation_sd() const {
  return std::sqrt(square(papilla.se) + square(input_sd.value_or(0)) + square(published_sd));
}

FigureTables figure_tables(const FigureOptions& options) {
  FingerModel papilla(options.finger, Preset::Papilla, options.threads, options.sampling);
  FingerModel m3(options.finger, Preset::M3, options.threads, options.sampling);
  FigureTables out;
  const auto wanted = [&](const std::string& claim) {
    return options.claims.empty() ||
           std::find(options.claims.begin(), options.claims.end(),
                     claim == kGapTarget ? "B2" : claim) != options.claims.end();
  };
  for (const Shown& shown : options.claims.empty() ? shown_cases() : std::vector<Shown>{}) {
    if (options.started) options.started(shown.sample);
    add_rows(papilla, shown, out.rows);
    add_rows(m3, shown, out.rows);
  }
  if (options.started) options.started("printed numbers");
  std::vector<PublishedTarget> targets = printed_numbers();
  std::erase_if(targets, [&](const PublishedTarget& t) { return !wanted(t.claim); });
  for (const PublishedTarget& target : targets) {
    out.printed.push_back({target.claim, target.what, target.low, target.high, target.sd,
                           target.model(papilla), target.model(m3)});
  }
  std::vector<double> own;
  for (const PrintedNumber& p : out.printed) own.push_back(p.papilla.value);
  out.sets.push_back(set_of(options.finger.name, out.printed, std::move(own)));
  add_input_errors(out, targets, options);
  return out;
}

}  // namespace papilla::claims
