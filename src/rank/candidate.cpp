#include "rank/candidate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "estimate/parameters.h"

namespace papilla::rank {

Candidate::Candidate(const Regions& regions, FingerState state, const RankOptions& options)
    : regions_(regions),
      design_(regions.front()),
      options_(options),
      scene_(scene_of(design_)),
      fidelity_(fidelity_of(design_)) {
  scene_.finger.state = state;
  fidelity_.threads = options.threads;
  fidelity_.skins = options.batch;
  if (std::any_of(options.criteria.begin(), options.criteria.end(),
                  [](const Criterion& c) { return c.info().appearance; })) {
    look_ = appearance_of(design_);
  }
}

void Candidate::extend() {
  solve([](const Finger& finger) { return finger; }, fidelity_, patches_);
  const int n = skins();
  Response response = respond(scene_, fidelity_, patches_);
  const auto values = [&] {
    std::vector<double> out;
    for (const Criterion& c : options_.criteria) out.push_back(value(c, response));
    return out;
  };
  const std::vector<double> all = values();
  pseudo_.assign(all.size(), std::vector<double>(static_cast<std::size_t>(n)));
  const std::vector<std::vector<ResponsePoint>> without = std::move(response.without);
  response.without.clear();
  for (int k = 0; k < n; ++k) {
    response.points = without[static_cast<std::size_t>(k)];
    const std::vector<double> others = values();
    for (std::size_t c = 0; c < all.size(); ++c)
      pseudo_[c][static_cast<std::size_t>(k)] = n * all[c] - (n - 1) * others[c];
  }
}

void Candidate::step() {
  Fidelity few = step_fidelity(fidelity_of(design_));
  few.threads = options_.threads;
  const auto moved = [&](std::size_t direction, bool up) {
    const auto move = [&](const Finger& finger) {
      const FingerStep step = finger_steps(finger)[direction];
      return up ? step.up : step.down;
    };
    Scene scene = scene_;
    scene.finger = move(scene_.finger);
    PatchSet patches;
    solve(move, few, patches);
    return Resampled(respond(scene, few, patches));
  };
  std::vector<ParameterStep> ends;
  for (std::size_t k = 0; k < finger_steps(scene_.finger).size(); ++k)
    ends.push_back({moved(k, true), moved(k, false)});
  Response there;
  there.driven = scene_.drive.driven();
  for (const Criterion& c : options_.criteria) {
    const auto samples = step_samples(ends, [&](const std::vector<ResponsePoint>& points) {
      there.points = points;
      return std::optional(value(c, there));
    });
    steps_.push_back(*samples);
  }
}

// The next skins of the common sequence, as many as the fidelity says, on the moved finger.
void Candidate::solve(const std::function<Finger(const Finger&)>& move, Fidelity fidelity,
                      PatchSet& patches) const {
  const int count = static_cast<int>(regions_.size()), skins = fidelity.skins;
  for (int r = 0; r < count; ++r) {
    fidelity.first_skin = patches.skins();
    fidelity.skins = skins * (r + 1) / count - skins * r / count;
    if (fidelity.skins == 0) continue;
    const Design& region = regions_[static_cast<std::size_t>(r)];
    Scene scene = scene_of(region);
    scene.finger.state = scene_.finger.state;
    scene.finger = move(scene.finger);
    // One region is one scene: what its field rule lacks is measured once.
    PatchSet more =
        solve_patches(scene, region.texture, fidelity, count == 1 ? patches.field : FieldRatios{});
    if (patches.skins() == 0) {
      patches = std::move(more);
    } else {
      patches.add(more);
    }
  }
}

double Candidate::value(const Criterion& c, Response& response) const {
  response.appearance = look_;
  const auto v = summarise(c.expression.summary, c.expression.metric, response);
  if (!v || !std::isfinite(v->value)) {
    throw InputError(fmt::format("{} is not defined for \"{}\"{}", metric_text(c.expression),
                                 design_.title,
                                 look_ && look_->refused() ? ": " + look_->warning
                                 : response.driven         ? ""
                                                           : ": it is not driven (0 V)"));
  }
  return v->value;
}

}  // namespace papilla::rank
