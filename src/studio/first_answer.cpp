#include "studio/first_answer.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "estimate/voltage.h"
#include "forward/forward.h"
#include "geometry/texture.h"
#include "metrics/metrics.h"
#include "numerics/statistics.h"
#include "studio/form.h"

namespace papilla::studio {
namespace {

constexpr std::array<QuantityMetric, 3> kCarried{kFriction, kFrictionOn, kModulation};

// A quick level, and what a refined answer usually is of its own: of kCarried.
struct QuickLevel {
  int grid;
  std::array<double, 3> usual;
};
// The first that has enough pixels on the smallest feature, else the last.
constexpr std::array<QuickLevel, 3> kLevels{
    {{64, {0.69, 0.64, 0.83}}, {96, {0.77, 0.7, 0.85}}, {128, {0.84, 0.82, 0.94}}}};
constexpr int kSkins = 6, kEquilibria = 2;
// A law is carried to other drives: forces go on growing to so many times the anchor's load.
constexpr double kBeyond = 4;
constexpr double kFewPixels = 3;  // of the smallest feature: its area is not its own below

// One standard error (docs/theory/studio.md): of the ratio of two levels, relative to what the
// quick number moved by and to what its skins leave open of that, and what is left where nothing
// moved; how far the usual ratio is off.
constexpr double kOfMove = 0.2, kOfSkins = 1.6, kFloor = 0.01;
constexpr std::array<double, 3> kSpread{0.06, 0.07, 0.145};

double root(double a, double b) { return std::hypot(a, b); }

const QuickLevel& quick_level(const Design& design) {
  const double smallest = facts(design.texture).margins.smallest();
  const auto enough = std::find_if(kLevels.begin(), kLevels.end(), [&](const QuickLevel& level) {
    return smallest >= kFewPixels * kWindow / level.grid;
  });
  return enough == kLevels.end() ? kLevels.back() : *enough;
}

// Of the ratio of two levels, where the quick number moved so from where it is known. Eq. studio.2
double drift(const QuickMove& moved) {
  return std::hypot(kFloor, kOfMove * moved.logarithm, kOfSkins * moved.error);
}

// By Eq. studio.1 and studio.2; true where the anchor has the number.
bool carry(const Anchor& anchor, const Response& quick, std::size_t i, const QuantityMetric& number,
           Measured& m) {
  const Measured &fine = anchor.refined.points[i].*number.quantity,
                 &coarse = anchor.quick.points[i].*number.quantity;
  if (coarse.value == 0 || fine.value == 0) return false;
  m.value *= fine.value / coarse.value;
  const double share = std::abs(m.value / fine.value);
  m.parts = fine.parts;
  m.parts.sampling *= share;
  for (const ErrorOrigin& origin : kErrorOrigins) {
    if (std::optional<double>& part = m.parts.*origin.part) *part *= share;
  }
  m.parts.method = root(m.parts.method.value_or(0),
                        drift(quick_move(i, number, anchor.quick, quick)) * std::abs(m.value));
  return true;
}

// By Eq. studio.3.
void state_alone(const Plan& plan, bool field_known, double usual, double spread, Measured& m) {
  m.value *= usual;
  m.parts.sampling *= usual;
  for (const PlanStep& step : plan.steps) {
    if (step.piece == Piece::Field && !field_known)
      m.parts.field = root(m.parts.field.value_or(0), step.error * std::abs(m.value));
  }
  m.parts.method = root(m.parts.method.value_or(0), spread * std::abs(m.value));
}

}  // namespace

Fidelity quick_fidelity(const Design& design) {
  Fidelity out = fidelity_level("search");
  out.seed = static_cast<std::uint64_t>(design.accuracy.seed);
  out.grid = quick_level(design).grid;
  out.skins = kSkins;
  out.equilibrium_skins = kEquilibria;
  return out;
}

Anchor anchor_of(const Design& design, Response refined) {
  KeptPatches kept;  // the laws and the answer by them are of the same patches
  Anchor out{design,
             kept.solve(scene_of(design), design.texture, quick_fidelity(design)).laws,
             {},
             std::move(refined)};
  const auto sound = [](const AttractionLaw& law) { return law.status.sound(); };
  const bool hold = std::all_of(out.laws.begin(), out.laws.end(), [&](const LoadLaws& laws) {
    return std::all_of(laws.begin(), laws.end(), sound);
  });
  if (!hold) out.laws.clear();
  for (LoadLaws& laws : out.laws) {
    for (AttractionLaw& law : laws) law.sampled_off *= kBeyond, law.sampled_on *= kBeyond;
  }
  out.quick = quick_answer(design, &out, &kept);
  return out;
}

Response quick_answer(const Design& design, const Anchor* anchor, KeptPatches* kept) {
  const Scene scene = scene_of(design);
  const Fidelity fidelity = quick_fidelity(design);
  const std::vector<LoadLaws> laws = anchor ? anchor->laws : std::vector<LoadLaws>();
  Response out = respond(scene, fidelity,
                         kept ? kept->solve(scene, design.texture, fidelity, laws)
                              : solve_patches(scene, design.texture, fidelity, {}, laws));
  set_bridged_margins(out, scene, design.texture);  // as a refined answer has them
  return out;
}

bool carries(const Anchor& anchor, const Design& design) {
  if (anchor.refined.driven != design.drive.driven() ||
      quick_fidelity(design) != quick_fidelity(anchor.design))
    return false;
  const std::vector<FormKey> a = form_keys(anchor.design), b = form_keys(design);
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const FormKey& x, const FormKey& y) {
    const bool may_differ = y.type == KeyType::Number || y.type == KeyType::Text;
    return x.path == y.path && (x.value == y.value || may_differ);
  });
}

QuickMove quick_move(std::size_t point, const QuantityMetric& number, const Response& from,
                     const Response& to) {
  const double before = (from.points[point].*number.quantity).value,
               now = (to.points[point].*number.quantity).value;
  QuickMove out;
  if (before == now) return out;
  out.logarithm = before * now > 0 ? std::log(now / before) : 1;
  if (before == 0 || now == 0) return out;
  const std::vector<double> were = error_moves(error_samples_at(point, number, from).sampling),
                            are = error_moves(error_samples_at(point, number, to).sampling);
  for (std::size_t skin = 0; skin < std::min(were.size(), are.size()); ++skin)
    out.error = root(out.error, are[skin] / now - were[skin] / before);
  return out;
}

Response first_answer(const Response& quick, const Design& design, const Anchor* anchor) {
  Response out = quick;
  const QuickLevel& level = quick_level(design);
  for (std::size_t i = 0; i < out.points.size(); ++i) {
    ResponsePoint& point = out.points[i];
    for (std::size_t k = 0; k < kCarried.size(); ++k) {
      Measured& m = point.*kCarried[k].quantity;
      if (anchor && carry(*anchor, quick, i, kCarried[k], m)) continue;
      state_alone(out.plan, point.field_error.has_value(), level.usual[k], kSpread[k], m);
    }
  }
  return out;
}

double difference_drift(const Response& from, const Response& to) {
  const QuantityMetric number = to.driven ? kModulation : kFriction;
  double most = 0;
  for (std::size_t i = 0; i < to.points.size(); ++i)
    most = std::max(most, drift(quick_move(i, number, from, to)));
  return most;
}

}  // namespace papilla::studio
