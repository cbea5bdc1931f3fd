// Where a result steps: a number of a design swept, or a line between two designs, on common skins.
// An interval that its neighbours do not announce is halved ten times; what is left of it then is a
// step, beside what a move by a thousandth does (droplets that settle elsewhere).
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/constants.h"
#include "base/random.h"
#include "config/describe.h"
#include "design/design.h"
#include "forward/forward.h"
#include "metrics/metrics.h"

namespace papilla::tests {

inline constexpr int kPoints = 20, kHalvings = 10, kMoved = 5;
inline constexpr double kShare = 0.3;  // of a number, either way
// A step is at least so much of the value, and so many times what droplets do.
inline constexpr double kLeastStep = 0.01, kTimesNoise = 4;

inline const std::array<const char*, 3> kQuantities{"mean modulation", "variation", "mean F_off"};
using Numbers = std::array<double, kQuantities.size()>;

// A way through designs: t in 0 ... 1; nothing where a design contradicts itself.
struct Line {
  std::string design, key;
  std::function<std::optional<Design>(double t)> at;
};

inline std::optional<Numbers> numbers(const Line& line, double t, const Fidelity& fidelity) {
  const std::optional<Design> design = line.at(t);
  if (!design || !problems(design->texture).empty()) return std::nullopt;
  try {
    const Response r = evaluate(scene_of(*design), design->texture, fidelity);
    for (const ResponsePoint& p : r.points)
      if (p.oxide_margin < 1) return std::nullopt;  // breaks down: a film nearly cut through
    const auto of = [&](Summary summary, const Metric& metric) {
      const auto value = summarise(summary, metric, r);
      return value ? value->value : 0;
    };
    return Numbers{of(Summary::Mean, kModulation), of(Summary::Variation, kModulation),
                   of(Summary::Mean, kFriction)};
  } catch (const std::exception&) {
    return std::nullopt;  // refused: a film cut through, a shape that cannot be
  }
}

struct Sweep {
  std::vector<double> place;
  std::vector<Numbers> value;
  Numbers noise{};  // what a move by a thousandth does beyond the slope
};

inline Sweep sweep(const Line& line, const Fidelity& fidelity) {
  Sweep out;
  for (int i = 0; i <= kPoints; ++i) {
    const double t = static_cast<double>(i) / kPoints;
    if (const auto n = numbers(line, t, fidelity)) {
      out.place.push_back(t);
      out.value.push_back(*n);
    }
  }
  for (int k = 0; k < kMoved && out.place.size() > 1; ++k) {
    const std::size_t i =
        static_cast<std::size_t>(2 * k + 1) * (out.place.size() - 1) / (2 * kMoved);
    const auto n = numbers(line, out.place[i] + 1e-3, fidelity);
    for (std::size_t q = 0; n && q < kQuantities.size(); ++q) {
      const double slope = kPoints * (out.value[i + 1][q] - out.value[i][q]);
      out.noise[q] = std::max(out.noise[q], std::abs((*n)[q] - out.value[i][q] - 1e-3 * slope));
    }
  }
  return out;
}

// The interval of one quantity that its neighbours announce least, halved.
struct Judged {
  std::size_t quantity = 0;
  double place = 0, value = 0;
  double unannounced = 0, step = 0, moved = 0;  // relative to the value
  bool is_step = false;
};

inline std::optional<Judged> judged(const Line& line, const Sweep& s, std::size_t q,
                                    const Fidelity& fidelity) {
  const auto change = [&](std::size_t i) { return s.value[i + 1][q] - s.value[i][q]; };
  std::size_t worst = 0;
  double most = 0;
  for (std::size_t i = 1; i + 2 < s.value.size(); ++i) {
    const double unannounced = std::abs(change(i) - 0.5 * (change(i - 1) + change(i + 1)));
    if (unannounced > most) most = unannounced, worst = i;
  }
  if (worst == 0) return std::nullopt;
  double low = s.place[worst], high = s.place[worst + 1], at_low = s.value[worst][q],
         at_high = s.value[worst + 1][q];
  const double size = std::abs(at_low);
  const auto counts = [&](double step) {
    return step > kLeastStep * size && step > kTimesNoise * s.noise[q];
  };
  for (int k = 0; k < kHalvings && counts(std::abs(at_high - at_low)); ++k) {
    const double middle = 0.5 * (low + high);
    const auto n = numbers(line, middle, fidelity);
    if (!n) return std::nullopt;
    const double between = (*n)[q];
    if (std::abs(at_high - between) > std::abs(between - at_low)) {
      low = middle, at_low = between;
    } else {
      high = middle, at_high = between;
    }
  }
  const double step = std::abs(at_high - at_low);
  return Judged{q, low, size, most / size, step / size, s.noise[q] / size, counts(step)};
}

// Of all quantities of a line.
inline std::vector<Judged> judge_steps(const Line& line, const Fidelity& fidelity) {
  std::vector<Judged> out;
  const Sweep s = sweep(line, fidelity);
  for (std::size_t q = 0; q < kQuantities.size() && s.place.size() > 5; ++q) {
    if (const auto one = judged(line, s, q, fidelity)) out.push_back(*one);
  }
  return out;
}

inline std::vector<std::string> kind_keys(const std::string& kind) {
  std::vector<std::string> out{fmt::format("texture.type=\"{}\"", kind),
                               "environment.relative_humidity=[\"15 %\", \"75 %\"]"};
  const bool numbers_of_array = kind != "random_rough" && kind != "particle_film";
  if (numbers_of_array) out.emplace_back("texture.period=\"3 um\"");

  if (kind == "hole_array" || kind == "pillar_array" || kind == "cap_array")
    out.emplace_back("texture.diameter=\"1.6 um\"");
  if (kind == "hole_array" || kind == "pillar_array" || kind == "grating") {
    out.emplace_back("texture.wall_angle=\"60 deg\"");
    out.emplace_back("texture.edge_radius=\"60 nm\"");
  }
  if (kind == "grating" || kind == "v_grooves") out.emplace_back("texture.width=\"1.4 um\"");
  return out;
}

inline const std::array<const char*, 8> kStepKinds{"hole_array",   "pillar_array", "grating",
                                                   "v_grooves",    "waves",        "cap_array",
                                                   "random_rough", "particle_film"};

inline std::vector<Line> every_number(const std::string& folder) {
  std::vector<Line> out;
  for (const char* kind : kStepKinds) {
    for (const char* process : {"conformal", "directional", "planar"}) {
      std::vector<std::string> keys = kind_keys(kind);
      keys.push_back(fmt::format("surface.process=\"{}\"", process));
      keys.emplace_back("model.water=\"threshold\"");
      const std::string name = fmt::format("{} {}", kind, process);
      Design base;
      try {
        base = read_design(folder + "/m3_samples/common.toml", keys);
      } catch (const std::exception&) {
        continue;  // a planar film under what has no depth
      }
      for (const NumberField& field : number_fields(base)) {
        const std::string path = field.path;
        const bool texture = path.starts_with("texture."), surface = path.starts_with("surface.");
        // The finger and the air know nothing of the process.
        if (std::string(process) != "conformal" && !texture && !surface) continue;
        if (path.starts_with("accuracy.") || path.ends_with("seed") || *field.value == 0) continue;
        if (path.find("relative_humidity") != std::string::npos) continue;  // an increasing list
        const double low = *field.value * (1 - kShare), high = *field.value * (1 + kShare);
        out.push_back({name, path, [=](double t) {
                         Design d = base;
                         *find_number_field(number_fields(d), path).value = low + t * (high - low);
                         return std::optional(d);
                       }});
      }
    }
  }
  return out;
}

struct Walk {
  const char *name, *water;
  bool period;
};
inline constexpr std::array<Walk, 3> kWalks{{{"one period", "threshold", false},
                                             {"period too", "threshold", true},
                                             {"droplets", "droplets", false}}};

inline std::vector<Line> random_lines(const std::string& folder, int count, const Walk& walk) {
  std::vector<Line> out;
  RandomStream random(7, walk.name);
  while (static_cast<int>(out.size()) < count) {
    const char* kind = kStepKinds[static_cast<std::size_t>(random.below(kStepKinds.size()))];
    std::vector<std::string> keys = kind_keys(kind);
    keys.push_back(fmt::format("surface.process=\"{}\"",
                               std::array{"conformal", "directional",
                                          "planar"}[static_cast<std::size_t>(random.below(3))]));
    keys.push_back(fmt::format("model.water=\"{}\"", walk.water));
    Design base;
    try {
      base = read_design(folder + "/m3_samples/common.toml", keys);
    } catch (const std::exception&) {
      continue;
    }
    // From half to twice of every number of texture, surface and drive.
    std::vector<std::pair<std::string, std::array<double, 2>>> ends;
    for (const NumberField& field : number_fields(base)) {
      const std::string& path = field.path;
      const bool varies = path.starts_with("texture.") || path.starts_with("surface.contact") ||
                          path.starts_with("surface.dielectric.0.thickness") ||
                          path == "drive.amplitude" || path == "finger.load";
      if (!walk.period && path == "texture.period") continue;
      if (!varies || path.ends_with("seed") || *field.value == 0) continue;
      const auto end = [&] { return *field.value * std::exp2(random.uniform(-0.7, 0.7)); };
      ends.push_back({path, {end(), end()}});
    }
    out.push_back({fmt::format("{} line {}", kind, out.size()), walk.name, [=](double t) {
                     Design d = base;
                     for (const auto& [path, end] : ends) {
                       const NumberField& field = find_number_field(number_fields(d), path);
                       *field.value = end[0] + t * (end[1] - end[0]);
                     }
                     return std::optional(d);
                   }});
  }
  return out;
}

}  // namespace papilla::tests
