#include "rank/candidate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <variant>

#include "base/error.h"
#include "base/parallel.h"
#include "estimate/belief.h"
#include "scene/uncertainty.h"

namespace papilla::rank {

namespace {

// Another arrangement of what is random in a texture; whether anything is.
bool rearrange(Texture& texture, int by) {
  bool random = std::visit(
      [&](auto& kind) {
        if constexpr (requires { kind.seed; }) {
          kind.seed += by;
          return true;
        } else {
          return false;
        }
      },
      texture.kind);
  if (std::vector<Texture>* parts = roles(texture).parts) {
    for (Texture& part : *parts) random = rearrange(part, by) || random;
  }
  return random;
}

bool looked_at(const RankOptions& options) {
  return std::any_of(options.criteria.begin(), options.criteria.end(),
                     [](const Criterion& c) { return c.info().appearance; });
}

// A finger is in the state that is asked for; what stands in its place has none.
Scene scene_in(const Design& design, FingerState state) {
  Scene scene = scene_of(design);
  if (!design.counterface.in_place()) scene.finger.state = state;
  return scene;
}

// The mean over regions; of one that has no numbers, that.
Optics mean_look(const std::vector<Optics>& regions) {
  Optics out = regions.front();
  for (double Look::*number : kLookNumbers) out.*number = 0;
  const double share = 1 / static_cast<double>(regions.size());
  for (const Optics& region : regions) {
    if (region.refused()) return region;
    if (out.warning.empty()) out.warning = region.warning;
    for (double Look::*number : kLookNumbers) out.*number += share * region.*number;
  }
  return out;
}

}  // namespace

Candidate::Candidate(const Regions& regions, FingerState state, const RankOptions& options)
    : regions_(regions),
      design_(regions.front()),
      options_(options),
      state_(state),
      scene_(scene_in(design_, state)),
      fidelity_(fidelity_of(design_)) {
  for (const Criterion& c : options.criteria) {
    const auto* look = std::get_if<LookMetric>(&c.expression.metric);
    if (look && look->number == &Look::sparkle && !design_.view.panel.present()) {
      throw InputError(
          "sparkle needs the subpixels of a panel: view.panel.subpixel_width and "
          "view.panel.subpixel_height");
    }
  }
  if (looked_at(options)) {
    for (const Design& region : regions) {
      Texture texture = region.texture;
      random_ = rearrange(texture, 0) || random_;
    }
  }
  fidelity_.threads = options.threads;
  // A region that met no skin yet would be in no number.
  fidelity_.skins = std::max(options.batch, static_cast<int>(regions.size()));
}

int Candidate::tried() const { return options_.felt() ? skins_ : static_cast<int>(looks_.size()); }

std::string Candidate::look_warning() const {
  for (const Optics& look : looks_) {
    if (!look.warning.empty()) return look.warning;
  }
  return {};
}

// A look for every skin: the next arrangements where something is random.
void Candidate::look_on() {
  if (!looked_at(options_)) return;
  std::vector<std::vector<Optics>> next;
  const auto count = static_cast<int>(looks_.size());
  const int wanted = random_ ? skins() : 1;
  next.resize(static_cast<std::size_t>(std::max(0, wanted - count)));
  parallel_for(
      static_cast<int>(next.size()),
      [&](int k) {
        for (const Design& region : regions_) {
          Design other = region;
          rearrange(other.texture, count + k);
          next[static_cast<std::size_t>(k)].push_back(appearance_of(other));
        }
      },
      options_.threads);
  for (const std::vector<Optics>& regions : next) looks_.push_back(mean_look(regions));
}

void Candidate::extend() {
  // A look takes no finger that presses.
  if (options_.felt()) solve([](Scene&) {}, fidelity_, patches_, known_);
  skins_ += fidelity_.skins;
  const int n = skins_;
  look_on();
  Response response;
  response.driven = scene_.drive.driven();
  if (options_.felt()) response = respond(scene_, fidelity_, patches_);
  trouble_ = text(response.said());
  const auto values = [&] {
    std::vector<double> out;
    for (const Criterion& c : options_.criteria)
      out.push_back(value(c, response, looks_.empty() ? nullptr : &looks_.front()));
    return out;
  };
  values_ = values();
  pseudo_.assign(values_.size(), std::vector<double>(static_cast<std::size_t>(n)));
  const std::vector<std::vector<ResponsePoint>> without = std::move(response.without);
  response.without.clear();
  for (int k = 0; k < n; ++k) {
    if (options_.felt()) response.points = without[static_cast<std::size_t>(k)];
    const std::vector<double> others = values();
    for (std::size_t c = 0; c < values_.size(); ++c) {
      const bool seen = options_.criteria[c].info().appearance;
      pseudo_[c][static_cast<std::size_t>(k)] =
          seen ? value(options_.criteria[c], response,
                       &looks_[static_cast<std::size_t>(k) % looks_.size()])
               : n * values_[c] - (n - 1) * others[c];
    }
  }
  move_values();
}

std::vector<double> Candidate::member_weights() const {
  std::vector<double> out;
  if (scene_.finger.belief.empty()) return out;
  for (const BeliefMember& m : belief_of(scene_.finger).members) out.push_back(m.weight);
  return out;
}

void Candidate::step() {
  const bool believed = !scene_.finger.belief.empty();
  Fidelity few = model_cost(scene_, fidelity_of(design_)).fidelity;
  few.threads = options_.threads;
  const auto moved = [&](const std::function<void(Scene&)>& move) {
    Scene scene = scene_;
    move(scene);
    PatchSet patches;
    std::vector<RegionLaws> known;
    solve(move, few, patches, known);
    return Resampled(respond(scene, few, patches));
  };
  if (!believed) {
    const auto end = [&](std::size_t direction, bool up) {
      return moved([&](Scene& scene) {
        FingerStep step = finger_steps(scene.finger)[direction];
        scene.finger = std::move(up ? step.up : step.down);
      });
    };
    for (std::size_t k = 0; k < finger_steps(scene_.finger).size(); ++k)
      moved_.parameters.steps.push_back({end(k, true), end(k, false)});
  } else {
    const Belief belief = belief_of(scene_.finger);
    moved_.belief.own = moved([](Scene&) {});
    for (const BeliefMember& member : belief.members) {
      moved_.belief.members.push_back({member.weight, member.hypothesis, moved([&](Scene& scene) {
                                         MemberScene at =
                                             with_member(belief, member, scene.finger, scene.model);
                                         scene.finger = std::move(at.finger);
                                         scene.model = at.model;
                                       })});
    }
  }
  move_values();
}

// Members move the value on all skins that were met, as they move that of an evaluation; the few
// skins and pixels that they are run on have another value. Eq. accuracy.15
void Candidate::move_values() {
  steps_.clear();
  if (moved_.parameters.steps.empty() && moved_.belief.members.empty()) return;  // not solved
  Response there;
  there.driven = scene_.drive.driven();
  for (std::size_t k = 0; k < options_.criteria.size(); ++k) {
    const Criterion& c = options_.criteria[k];
    const Number number = [&](const std::vector<ResponsePoint>& points) {
      there.points = points;
      return std::optional(value(c, there, looks_.empty() ? nullptr : &looks_.front()));
    };
    if (moved_.belief.members.empty()) {
      steps_.push_back(*step_samples(moved_.parameters.steps, number));
    } else {
      const bool sign_kept = keeps_sign(c.expression.summary, c.expression.metric);
      steps_.push_back(belief_values(moved_.belief, number, values_[k], sign_kept)->moves);
    }
  }
}

// The next skins of the common sequence, as many as the fidelity says, in the moved scene: skin by
// skin to the next region, so that all have as many but for one.
void Candidate::solve(const std::function<void(Scene&)>& move, Fidelity fidelity, PatchSet& patches,
                      std::vector<RegionLaws>& known) const {
  const int count = static_cast<int>(regions_.size()), skins = fidelity.skins;
  const int next = patches.skins();
  known.resize(regions_.size());
  for (int k = 0; k < std::min(count, skins); ++k) {
    const int r = (next + k) % count;
    fidelity.first_skin = patches.skins();
    fidelity.skins = (skins - k + count - 1) / count;
    const Design& region = regions_[static_cast<std::size_t>(r)];
    Scene scene = scene_in(region, state_);
    move(scene);
    RegionLaws& laws = known[static_cast<std::size_t>(r)];
    PatchSet more = solve_patches(scene, region.texture, fidelity, laws.field, laws.laws);
    laws = {more.field, more.laws};
    if (patches.skins() == 0) {
      patches = std::move(more);
    } else {
      patches.add(more);
    }
  }
}

double Candidate::value(const Criterion& c, Response& response, const Optics* look) const {
  response.appearance = look ? std::optional(*look) : std::nullopt;
  const auto v = summarise(c.expression.summary, c.expression.metric, response);
  if (!v || !std::isfinite(v->value)) {
    throw InputError(fmt::format("{} is not defined for \"{}\"{}", metric_text(c.expression),
                                 design_.title,
                                 look && look->refused() ? ": " + look->warning
                                 : response.driven       ? ""
                                                         : ": it is not driven (0 V)"));
  }
  return v->value;
}

}  // namespace papilla::rank
