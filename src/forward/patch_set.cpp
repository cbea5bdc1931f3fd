#include "forward/patch_set.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>

#include "base/check.h"
#include "base/parallel.h"
#include "base/watch.h"
#include "forward/kept_patches.h"
#include "forward/load_law.h"
#include "forward/patch_setup.h"
#include "forward/point.h"
#include "forward/scene_terms.h"

namespace papilla::forward {
namespace {

// One skin at every humidity: contact starts from that of the humidity before.
class SkinRun {
 public:
  SkinRun(const PatchSetup& setup, const PatchSet& set,
          const std::vector<std::shared_ptr<const ContactKernel>>& kernels, int k,
          KeptPatches::Skin* kept)
      : setup_(setup),
        set_(set),
        kernels_(kernels),
        kept_(kept),
        height_(kept && kept->contact ? kept->height : setup.height(setup.skin(k))),
        members_(setup.water_members(k)),
        start_(set.bridges[0].pressures().size()) {
    if (kept) kept->height = height_;
  }

  // At each patch pressure, over the water; sample: also the first water's in equilibrium.
  std::vector<SolvedPatch> at(std::size_t i, bool sample) {
    const double humidity = setup_.scene().environment.relative_humidity[i];
    std::vector<SolvedPatch> patches;
    for (const double pressure : set_.bridges[i].pressures()) {
      Starts& start = start_[patches.size()];
      patches.push_back(over_members(
          members_, setup_.plan(), setup_.fidelity(), sample ? &start.settled : nullptr,
          [&](const WaterMember& member) {
            PatchProblem problem =
                setup_.problem(height_, *kernels_[i], humidity, pressure, member);
            problem.field_correction = set_.field[i].correction;
            return problem;
          },
          [&](const PatchProblem& problem) {
            return kept_ ? solve_kept(problem, start.given)
                         : solve_new(problem, start.given, sample);
          }));
    }
    return patches;
  }

 private:
  // The patch that comes next in the order of the run, from what is kept of it.
  DrivenPatch solve_kept(const PatchProblem& problem, PatchStates& start) {
    const bool is_new = next_ == kept_->patches.size();
    if (is_new) kept_->patches.emplace_back();
    UndrivenPatch& patch = kept_->patches[next_++];
    if (!kept_->water || is_new) {
      patch = kept_->contact && !is_new
                  ? wet_patch(problem, setup_.plan(), setup_.fidelity(), patch.dry)
                  : undriven_patch(problem, setup_.plan(), setup_.fidelity(), start);
    } else {
      patch.dry_gap.costs = {};  // of the run before
    }
    start.dry = patch.dry.gap.empty() ? ContactSolution() : patch.dry;
    return {drive_patch(problem, setup_.plan(), setup_.fidelity(), patch), &patch};
  }

  // samples: what it was before the drive is asked for.
  DrivenPatch solve_new(const PatchProblem& problem, PatchStates& start, bool samples) {
    return {solve_patch(problem, setup_.plan(), setup_.fidelity(), start, nullptr,
                        samples ? &before_ : nullptr),
            samples ? &before_ : nullptr};
  }

  const PatchSetup& setup_;
  const PatchSet& set_;
  const std::vector<std::shared_ptr<const ContactKernel>>& kernels_;
  KeptPatches::Skin* kept_;
  std::size_t next_ = 0;  // of the kept patches
  std::vector<double> height_;
  std::vector<WaterMember> members_;
  struct Starts {
    PatchStates given, settled;
  };
  std::vector<Starts> start_;  // one per patch pressure
  UndrivenPatch before_;       // of the last patch
};

// What grid and method add to the last point, which is that of all skins.
void add_measured_error(const MeasuredError& error, std::size_t humidity, ResponsePoint& point) {
  if (!error.pull_in.empty()) point.status.note(error.pull_in[humidity]);
  for (std::size_t m = 0; m < kPointQuantities.size(); ++m) {
    Measured& measured = point.*kPointQuantities[m].value;
    std::optional<double>& part = measured.parts.*error.origin;
    part = std::hypot(part.value_or(0), error.size[humidity][m] * std::abs(measured.value));
  }
}

}  // namespace

PatchCosts PatchSet::costs(int first) const {
  PatchCosts out;
  for (const std::vector<PatchResult>& skins : results) {
    for (std::size_t k = static_cast<std::size_t>(first); k < skins.size(); ++k)
      out += skins[k].costs;
  }
  return out;
}

void PatchSet::add(const PatchSet& other) {
  PAPILLA_CHECK(results.size() == other.results.size(), "the same humidities");
  for (std::size_t i = 0; i < results.size(); ++i) {
    results[i].insert(results[i].end(), other.results[i].begin(), other.results[i].end());
  }
  // Refitted are the laws that all of them are by: those of the skins before.
  const bool by_other_laws =
      other.solved.size() != solved.size() ||
      std::any_of(other.solved.begin(), other.solved.end(),
                  [](const auto& skins) { return samples_among(skins) > 0; });
  if (by_other_laws) solved.clear();
  for (std::size_t i = 0; i < solved.size(); ++i)
    solved[i].insert(solved[i].end(), other.solved[i].begin(), other.solved[i].end());
  seconds += other.seconds;
}

namespace {

PatchSet solve(const Scene& scene, const Texture& texture, const Fidelity& fidelity,
               const FieldRatios& field, const std::vector<LoadLaws>& laws, KeptPatches* kept) {
  const auto begin = std::chrono::steady_clock::now();
  const PatchSetup setup(scene, texture, fidelity);
  const std::vector<double>& humidities = scene.environment.relative_humidity;
  PAPILLA_CHECK(!humidities.empty(), "one humidity at least");
  PatchSet set;
  set.plan = setup.plan();
  set.field = field.empty() ? field_ratios(scene, texture, fidelity) : field;
  PAPILLA_CHECK(set.field.size() == humidities.size(), "one field ratio per humidity");
  std::vector<std::shared_ptr<const ContactKernel>> kernels;
  for (const double rh : humidities) {
    kernels.push_back(contact_kernel(setup.scene(), setup.body(), set.plan.grid, rh));
    set.bridges.emplace_back(setup.scene(), fidelity, set.plan.grid, rh, setup.body(),
                             setup.levels());
  }
  set.results.resize(humidities.size());
  const int samples = laws.empty() ? sampled_skins(setup, set.plan) : 0;
  const int solved_skins = std::max(fidelity.skins, samples);
  std::vector<std::vector<std::vector<SolvedPatch>>> solved(
      humidities.size(),
      std::vector<std::vector<SolvedPatch>>(static_cast<std::size_t>(solved_skins)));
  if (kept) kept->begin(setup);
  const Watch* const watch = Watch::current();
  parallel_for(
      solved_skins,
      [&](int k) {
        SkinRun run(setup, set, kernels, k, kept ? &kept->skin(k) : nullptr);
        for (std::size_t i = 0; i < humidities.size(); ++i) {
          if (watch) watch->before_piece();  // between patches, not only between skins
          solved[i][static_cast<std::size_t>(k)] = run.at(i, k < samples);
        }
      },
      fidelity.threads);
  if (kept) kept->end();
  set.laws = laws;
  for (std::size_t i = 0; i < humidities.size() && samples > 0; ++i)
    set.laws.push_back(load_laws(set.bridges[i], solved[i]));
  for (std::size_t i = 0; i < humidities.size(); ++i)
    set.results[i] = combined(set.bridges[i], set.laws.empty() ? LoadLaws{} : set.laws[i],
                              std::span(solved[i]).first(static_cast<std::size_t>(fidelity.skins)));
  if (!set.laws.empty() && samples <= fidelity.skins) set.solved = std::move(solved);
  set.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return set;
}

}  // namespace

PatchSet solve_patches(const Scene& scene, const Texture& texture, const Fidelity& fidelity,
                       const FieldRatios& field, const std::vector<LoadLaws>& laws) {
  return solve(scene, texture, fidelity, field, laws, nullptr);
}

PatchSet KeptPatches::solve(const Scene& scene, const Texture& texture, const Fidelity& fidelity,
                            const std::vector<LoadLaws>& laws) {
  return forward::solve(scene, texture, fidelity, {}, laws, this);
}

Response respond(const Scene& given, const Fidelity& fidelity, const PatchSet& set) {
  const Scene scene = in_its_state(given);
  Response response;
  response.plan = set.plan;
  response.controls = set.controls;
  response.fidelity = fidelity;
  response.fidelity.skins = set.skins();
  response.driven = set.plan.field;
  response.seconds = set.seconds;
  const PointSetting setting{scene, response.plan, fidelity, set.area_factor};
  const Environment& air = scene.environment;
  if (set.skins() > 1) response.without.resize(static_cast<std::size_t>(set.skins()));
  for (std::size_t i = 0; i < air.relative_humidity.size(); ++i) {
    std::vector<std::vector<PatchResult>> by_own_laws;
    if (!set.solved.empty()) by_own_laws = without_each(set.bridges[i], set.solved[i]);
    SkinPoints points =
        skin_points(setting, air.relative_humidity[i], air.weights.empty() ? 1 : air.weights[i],
                    set.bridges[i], set.results[i], std::move(by_own_laws));
    response.points.push_back(std::move(points.all));
    for (std::size_t k = 0; k < response.without.size(); ++k)
      response.without[k].push_back(std::move(points.without[k]));
    add_field_error(set.field[i], load_exponents(fidelity.load_exponent, scene.touch.coefficient),
                    response.points.back());
    for (const MeasuredError& error : set.errors)
      add_measured_error(error, i, response.points.back());
    if (set.plan.water) note_water(response.points.back(), scene.finger.water);
  }
  PatchCosts costs = set.costs();
  response.piece_seconds = costs.seconds;
  for (const MeasuredError& error : set.errors) {
    costs += error.costs;
    response.seconds += error.seconds;
  }
  response.contact_solves = costs.contact_solves;
  response.fft_pairs = costs.fft_pairs;
  return response;
}

PatchPicture picture_patch(const Scene& scene, const Texture& texture, const Fidelity& fidelity,
                           double relative_humidity, int index, int placement, double pressed) {
  const PatchSetup setup(scene, texture, fidelity);
  const Grid& grid = setup.plan().grid;
  PatchPicture picture{setup.texture(), setup.skin(index), {}};
  const std::vector<double> height = setup.height(picture.skin);
  const auto kernel = contact_kernel(setup.scene(), setup.body(), grid, relative_humidity);
  picture.pressure = pressed * ScaleBridge(setup.scene(), fidelity, grid, relative_humidity,
                                           setup.body(), setup.levels())
                                   .mean_pressure();
  const WaterMember mean{1, water_stream(fidelity.first_skin + index, placement)};
  PatchStates start;
  solve_patch(setup.problem(height, *kernel, relative_humidity, picture.pressure, mean),
              setup.plan(), fidelity, start, &picture.fields);
  return picture;
}

}  // namespace papilla::forward
