#include "forward/pull_in.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "base/check.h"
#include "base/constants.h"
#include "base/parallel.h"
#include "forward/coupling.h"
#include "forward/electric_path.h"
#include "forward/field_ratio.h"
#include "forward/patch_setup.h"
#include "forward/scale_bridge.h"
#include "forward/scene_terms.h"

namespace papilla::forward {
namespace {

// The total load over the nominal one, from state to state.
constexpr double kFirstLoad = 1.05, kStep = 1.12, kLastLoad = 40;

// The top of a parabola through three points (x, y) with the middle one highest.
double top(const double (&x)[3], const double (&y)[3]) {
  const double d1 = (y[1] - y[0]) / (x[1] - x[0]), d2 = (y[2] - y[1]) / (x[2] - x[1]);
  const double bend = (d2 - d1) / (x[2] - x[0]);
  if (!(bend < 0)) return y[1];
  const double at = std::clamp(0.5 * (x[0] + x[1]) - 0.5 * d1 / bend, x[0], x[2]);
  return y[0] + (at - x[0]) * (d1 + bend * (at - x[1]));
}

// The patches of a few skins at one humidity, closed by one mean attraction.
class MeanPatch {
 public:
  MeanPatch(const Scene& given, const Texture& texture, const Fidelity& fidelity,
            double relative_humidity)
      : setup_(given, texture, fidelity), humidity_(relative_humidity) {
    const Grid& grid = setup_.plan().grid;
    kernel_ = contact_kernel(setup_.scene(), setup_.body(), grid, humidity_);
    pressure_ =
        ScaleBridge(setup_.scene(), fidelity, grid, humidity_, setup_.body()).mean_pressure();
    PAPILLA_CHECK(setup_.scene().drive.driven() && pressure_ > 0, "a driven, loaded patch");
    const int skins = std::min(std::max(fidelity.equilibrium_skins, 1), fidelity.skins);
    heights_.resize(static_cast<std::size_t>(skins));
    branches_.resize(heights_.size());
    peak_ = source_voltage(setup_.scene(), humidity_).peak;
    driven_ = setup_.scene();
    driven_.drive.control = DriveControl::Voltage;
    parallel_for(
        skins,
        [&](int k) {
          heights_[k] = setup_.height(setup_.skin(k));
          PatchProblem problem = setup_.problem(heights_[k], *kernel_, humidity_, pressure_,
                                                {1, water_stream(fidelity.first_skin + k, 0)});
          branches_[k] = std::make_unique<PatchBranch>(problem, setup_.plan(), fidelity);
        },
        fidelity.threads);
  }

  double pressure() const { return pressure_; }
  void close(double attraction) {
    parallel_for(
        static_cast<int>(branches_.size()), [&](int k) { branches_[k]->close(attraction); },
        setup_.fidelity().threads);
  }
  // The mean attraction of the closed gaps at so many times the voltage of the drive [Pa].
  double attraction(double times) {
    driven_.drive.amplitude = times * peak_;
    std::vector<double> of(branches_.size());
    parallel_for(
        static_cast<int>(of.size()), [&](int k) { of[k] = branches_[k]->attraction(driven_); },
        setup_.fidelity().threads);
    double sum = 0;
    for (const double a : of) sum += a;
    return sum / static_cast<double>(of.size());
  }

 private:
  PatchSetup setup_;
  double humidity_, pressure_ = 0, peak_ = 0;
  std::shared_ptr<const ContactKernel> kernel_;
  Scene driven_;
  std::vector<std::vector<double>> heights_;
  std::vector<std::unique_ptr<PatchBranch>> branches_;
};

// The voltage, over that of the drive, at which the closed gaps attract so much; nothing below
// `most`: `most`.
double voltage_of(MeanPatch& patch, double wanted, double guess, double most) {
  constexpr double kExact = 1e-3;
  constexpr int kMost = 12;
  double low = 0, high = most, t = std::clamp(guess, 0.05, most);
  for (int k = 0; k < kMost; ++k) {
    const double found = patch.attraction(t);
    (found < wanted ? low : high) = t;
    if (std::abs(found - wanted) <= kExact * wanted) return t;
    if (found < wanted && t >= most) return most;
    // The pull goes with the square of the voltage, or less.
    double next = found > 0 ? t * std::sqrt(wanted / found) : high;
    if (!(next > low && next < high))
      next = high == most && found < wanted ? most : 0.5 * (low + high);
    t = next;
  }
  return t;
}

}  // namespace

PullIn pull_in(const Scene& scene, const Texture& texture, const Fidelity& fidelity,
               double relative_humidity) {
  constexpr double kPast = 0.97;  // of the highest voltage: the branch has turned
  MeanPatch patch(scene, texture, fidelity, relative_humidity);
  std::vector<double> loads, voltages;
  double highest = 0;
  for (double load = kFirstLoad; load < kLastLoad; load *= kStep) {
    const double attraction = (load - 1) * patch.pressure();
    patch.close(attraction);
    const double v =
        voltage_of(patch, attraction, voltages.empty() ? 0.5 : voltages.back(), kFarthestPullIn);
    loads.push_back(std::log(load));
    voltages.push_back(v);
    if (v >= kFarthestPullIn) return {};
    highest = std::max(highest, v);
    if (v < kPast * highest) break;
  }
  const std::size_t at = static_cast<std::size_t>(
      std::max_element(voltages.begin(), voltages.end()) - voltages.begin());
  if (at + 1 == voltages.size()) return {highest, false};
  if (at == 0) return {highest, true};
  return {std::min(top({loads[at - 1], loads[at], loads[at + 1]},
                       {voltages[at - 1], voltages[at], voltages[at + 1]}),
                   kFarthestPullIn),
          true};
}

}  // namespace papilla::forward
