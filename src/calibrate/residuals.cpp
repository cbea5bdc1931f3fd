#include "calibrate/residuals.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include "base/check.h"
#include "base/constants.h"
#include "base/files.h"
#include "config/writer.h"
#include "forward/forward.h"
#include "optim/trust_region.h"

namespace papilla::calibrate {

namespace {

// Steps that the correction is followed by, in prior widths: as far as a fit moves in its last
// rounds, and the ripples of a friction are small beside what it changes.
constexpr double kFollowedStep = 0.25;

// Of the band, or its one end.
double middle(const FitRow& row) {
  if (!std::isfinite(row.low)) return row.high;
  if (!std::isfinite(row.high)) return row.low;
  return (row.low + row.high) / 2;
}

// Tells what its scope has taken [s].
class Stopwatch {
 public:
  explicit Stopwatch(double& seconds) : seconds_(seconds) {}
  ~Stopwatch() {
    seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  double& seconds_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

std::string as_text(const SkinSampling& s) {
  return fmt::format("{} {} {} {}", s.level, s.skins, s.first_skin, s.grid);
}

// Of rows of unit length over the skins, the share of their correlations that is meant: what so few
// skins show by chance is left to the rows' own errors (Schaefer and Strimmer 2005, the target
// being no correlation). Eq. calibration.12
double meant_correlation(const std::vector<std::vector<double>>& rows) {
  double chance = 0, all = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      double correlation = 0, squares = 0;
      const auto n = static_cast<double>(rows[i].size());
      for (std::size_t k = 0; k < rows[i].size(); ++k) {
        const double product = rows[i][k] * rows[j][k];
        correlation += product;
        squares += square(product);
      }
      chance += n / (n - 1) * (squares - square(correlation) / n);
      all += square(correlation);
    }
  }
  return all > 0 ? std::max(0.0, 1 - chance / all) : 0;
}

// All that the model's answers depend on beside finger and sampling.
std::string problem_of(const Calibration& calibration, const std::vector<MeasuredGroup>& groups) {
  std::string out = PAPILLA_VERSION "\n" + read_bytes(calibration.file);
  out += maps_state(calibration.finger);
  if (!calibration.fit.empty()) out += designs_state("m3_samples");
  for (const MeasuredGroup& group : groups) {
    out += write_toml(to_table(group.design)) + maps_state(group.design);
    for (const std::size_t row : group.rows) out += fmt::format(" {}", row);
    for (const std::size_t at : group.humidity_of) out += fmt::format(" {}", at);
  }
  return out;
}

}  // namespace

double FitRow::own_deviation() const {
  double shared = 0;
  for (const double share : common) shared += square(share);
  return std::sqrt(square(sd) + square(sampling_sd) * std::max(0.0, 1 - shared));
}

const FitRow& worst_row(const std::vector<FitRow>& rows) {
  return *std::max_element(rows.begin(), rows.end(), [](const FitRow& a, const FitRow& b) {
    return std::abs(a.miss) < std::abs(b.miss);
  });
}

std::string worst_miss_text(const std::vector<FitRow>& rows) {
  const FitRow& row = worst_row(rows);
  return fmt::format("the worst is {} ({}), {:+.1f} standard deviations", row.source, row.what,
                     row.miss);
}

Residuals::Residuals(const Calibration& calibration, int threads, const std::string& folder)
    : calibration_(calibration), threads_(threads), factors_(calibration.data.size()) {
  const std::set<std::string> wanted(calibration.fit.begin(), calibration.fit.end());
  for (PublishedTarget& target : fittable_targets()) {
    if (wanted.count(target.claim)) targets_.push_back(std::move(target));
  }
  group_data();
  for (const PublishedTarget& t : targets_)
    rows_.push_back({t.claim, t.what, t.low, t.high, t.sd, 0, 0, 0});
  for (const FrictionDatum& d : calibration.data) add_rows(d);
  if (!folder.empty()) kept_ = KeptAnswers(folder, problem_of(calibration, groups_));
}

void Residuals::add_rows(const FrictionDatum& d) {
  const std::string state =
      d.state ? ", " + finger_state_names()[static_cast<std::size_t>(*d.state)] : "";
  const auto add = [&](const char* name, double value, double sd) {
    rows_.push_back({fmt::format("line {}", d.line),
                     fmt::format("{} of {} at {} N, {:.0f} % RH, {} V{}, mN", name,
                                 std::filesystem::path(d.design).stem().string(), d.load,
                                 100 * d.relative_humidity, d.amplitude, state),
                     value * 1e3, value * 1e3, sd * 1e3, 0, 0, 0});
  };
  if (d.off_sd > 0) add("F_off", d.off, d.off_sd);
  if (d.on_sd > 0) add("F_on", d.on, d.on_sd);
}

std::vector<Estimate> Residuals::model(const Calibration& from, std::span<const double> values) {
  return model(from, values,
               frictions(with_parameters(from, values), calibration_.sampling, false));
}

std::vector<Estimate> Residuals::model(const Calibration& from, std::span<const double> values,
                                       const std::vector<Friction>& friction) {
  const Finger finger = with_parameters(from, values);
  std::vector<Estimate> out =
      kept_.get("targets " + as_text(calibration_.sampling) + write_toml(to_table(finger)),
                targets_.size(), [&] {
                  const Stopwatch watch(target_seconds_);
                  FingerModel finger_model(finger, finger.calibrated_for.preset, threads_,
                                           calibration_.sampling);
                  std::vector<Estimate> answers;
                  for (const PublishedTarget& t : targets_)
                    answers.push_back(t.model(finger_model));
                  return answers;
                });
  const std::vector<Factor> factor = followed(from, values);
  for (std::size_t i = 0; i < friction.size(); ++i) {
    const auto add = [&](const Force& force, double log_factor) {
      const double by = 1e3 * std::exp(log_factor);
      out.push_back({by * force.estimate.value, by * force.estimate.se});
    };
    if (calibration_.data[i].off_sd > 0) add(friction[i].off, factor[i].off);
    if (calibration_.data[i].on_sd > 0) add(friction[i].on, factor[i].on);
  }
  return out;
}

std::vector<Residuals::Factor> Residuals::factors(const Finger& finger) {
  SkinSampling fine = calibration_.sampling;
  fine.level = calibration_.check.level;
  fine.grid = calibration_.check.grid;
  const std::vector<Friction> good = frictions(finger, fine, true),
                              fast = frictions(finger, calibration_.sampling, false);
  const auto of = [](const Force& from, const Force& to) {
    const double a = from.estimate.value, b = to.estimate.value;
    return a > 0 && b > 0 ? std::log(b / a) : 0;
  };
  std::vector<Factor> out;
  for (std::size_t i = 0; i < good.size(); ++i)
    out.push_back({of(fast[i].off, good[i].off), of(fast[i].on, good[i].on)});
  return out;
}

// Eq. calibration.6
std::vector<Residuals::Factor> Residuals::followed(const Calibration& from,
                                                   std::span<const double> values) const {
  std::vector<Factor> out = factors_;
  if (slopes_.empty()) return out;
  const std::vector<FitParameter> parameters = fit_parameters(from);
  const FitCoordinates coordinates(parameters);
  for (std::size_t k = 0; k < slopes_.size(); ++k) {
    const double moved = coordinates.to(k, values[k]) - corrected_at_[k];
    for (std::size_t i = 0; i < out.size(); ++i) {
      out[i].off += slopes_[k][i].off * moved;
      out[i].on += slopes_[k][i].on * moved;
    }
  }
  return out;
}

std::pair<double, double> Residuals::factors_between(const Calibration& from,
                                                     std::span<const double> values) const {
  double least = kInfinity, largest = 0;
  const std::vector<Factor> all = followed(from, values);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto look = [&](double log_factor, double sd) {
      if (!(sd > 0)) return;
      least = std::min(least, std::exp(log_factor));
      largest = std::max(largest, std::exp(log_factor));
    };
    look(all[i].off, calibration_.data[i].off_sd);
    look(all[i].on, calibration_.data[i].on_sd);
  }
  return largest > 0 ? std::pair(least, largest) : std::pair(1.0, 1.0);
}

double Residuals::correct(const Calibration& from, std::span<const double> values) {
  if (calibration_.data.empty()) return 0;
  const Finger finger = with_parameters(from, values);
  const std::vector<Factor> before = followed(from, values);
  const std::vector<Friction> fast = frictions(finger, calibration_.sampling, false);
  factors_ = factors(finger);
  const std::vector<FitParameter> parameters = fit_parameters(from);
  const FitCoordinates coordinates(parameters);
  corrected_at_.clear();
  for (std::size_t k = 0; k < values.size(); ++k)
    corrected_at_.push_back(coordinates.to(k, values[k]));
  double largest = 0;
  for (std::size_t i = 0; i < fast.size(); ++i) {
    const FrictionDatum& d = calibration_.data[i];
    const auto look = [&](double old, double now, const Force& force, double sd) {
      largest =
          std::max(largest, std::abs(std::exp(now) - std::exp(old)) * force.estimate.value / sd);
    };
    if (d.off_sd > 0) look(before[i].off, factors_[i].off, fast[i].off, d.off_sd);
    if (d.on_sd > 0) look(before[i].on, factors_[i].on, fast[i].on, d.on_sd);
  }
  return largest;
}

void Residuals::follow(const Calibration& from, std::span<const double> values,
                       const std::function<void(int)>& done) {
  slopes_.clear();
  if (calibration_.data.empty()) return;
  const std::vector<FitParameter> parameters = fit_parameters(from);
  const FitCoordinates coordinates(parameters);
  int evaluated = 0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    const auto at = [&](double x) {
      std::vector<double> moved(values.begin(), values.end());
      moved[k] = coordinates.from(k, x);
      const std::pair out(coordinates.to(k, moved[k]), factors(with_parameters(from, moved)));
      if (done) done(++evaluated);
      return out;
    };
    const double here = coordinates.to(k, values[k]);
    const auto [low, below] = at(here - kFollowedStep);
    const auto [high, above] = at(here + kFollowedStep);
    std::vector<Factor>& slope = slopes_.emplace_back();
    for (std::size_t i = 0; i < below.size(); ++i)
      slope.push_back({(above[i].off - below[i].off) / (high - low),
                       (above[i].on - below[i].on) / (high - low)});
  }
}

std::vector<std::string> Residuals::sources() const {
  std::vector<std::string> out;
  for (const PublishedTarget& t : targets_) out.push_back(t.claim);
  for (const FrictionDatum& d : calibration_.data) {
    const std::string design = std::filesystem::path(d.design).stem().string();
    if (d.off_sd > 0) out.push_back(design);
    if (d.on_sd > 0) out.push_back(design);
  }
  return out;
}

bool Residuals::residuals(const Calibration& from, std::span<const double> values,
                          std::span<double> r) {
  if (!answers(from, values, r)) return false;
  take_bands_off(r, bands());
  common().whiten(r);
  return true;
}

std::vector<double> Residuals::misses(std::vector<double> residuals) const {
  const CommonErrors together = common();
  together.colour(residuals);
  for (std::size_t i = 0; i < residuals.size(); ++i) residuals[i] /= together.deviation(i);
  return residuals;
}

// Eq. calibration.12
std::vector<Estimate> Residuals::weigh(const Calibration& from, std::span<const double> values) {
  const std::vector<Friction> friction =
      frictions(with_parameters(from, values), calibration_.sampling, false);
  std::vector<Estimate> here = model(from, values, friction);
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    rows_[i].sampling_sd = here[i].se;
    rows_[i].common.clear();
  }
  std::vector<std::vector<double>> moves;  // of unit length
  std::vector<FitRow*> measured;
  std::size_t row = targets_.size();
  const auto add = [&](const Force& force, double sd) {
    if (!(sd > 0)) return;
    FitRow& of = rows_[row++];
    double length = 0;
    for (const double move : force.moves) length = std::hypot(length, move);
    if (!(length > 0)) return;  // of one skin, or what no skin changes
    measured.push_back(&of);
    moves.push_back(force.moves);
    for (double& move : moves.back()) move /= length;
  };
  for (std::size_t i = 0; i < friction.size(); ++i) {
    add(friction[i].off, calibration_.data[i].off_sd);
    add(friction[i].on, calibration_.data[i].on_sd);
  }
  const double share = std::sqrt(meant_correlation(moves));
  for (std::size_t i = 0; i < measured.size(); ++i) {
    for (const double move : moves[i]) measured[i]->common.push_back(share * move);
  }
  return here;
}

CommonErrors Residuals::common() const {
  std::size_t skins = 0;
  for (const FitRow& row : rows_) skins = std::max(skins, row.common.size());
  if (skins < 2) return {};
  // Few skins know badly how far all of them are off; errors of each row's own average out.
  const double student =
      student_t_quantile(0.975, static_cast<int>(skins) - 1) / normal_quantile(0.975);
  Eigen::MatrixXd moves = Eigen::MatrixXd::Zero(size(), static_cast<Eigen::Index>(skins));
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const FitRow& row = rows_[i];
    for (std::size_t k = 0; k < row.common.size(); ++k)
      moves(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) =
          student * row.common[k] * row.sampling_sd / row.own_deviation();
  }
  return CommonErrors(moves);
}

bool Residuals::answers(const Calibration& from, std::span<const double> values,
                        std::span<double> r) {
  return answers(model(from, values), r);
}

bool Residuals::answers(const std::vector<Estimate>& values, std::span<double> r) const {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i].value)) return false;
    r[i] = (values[i].value - middle(rows_[i])) / rows_[i].own_deviation();
  }
  return true;
}

std::vector<RowBand> Residuals::bands() const {
  std::vector<RowBand> out;
  for (const FitRow& row : rows_) {
    const double unit = row.own_deviation();
    out.push_back({(row.low - middle(row)) / unit, (row.high - middle(row)) / unit});
  }
  return out;
}

std::vector<Residuals::Friction> Residuals::frictions(const Finger& finger,
                                                      const SkinSampling& sampling,
                                                      bool corrected) {
  const auto skins = static_cast<std::size_t>(sampling.skins);
  const std::size_t moved = skins > 1 ? skins : 0;
  const std::string question =
      fmt::format("frictions {} {} ", corrected, as_text(sampling)) + write_toml(to_table(finger));
  // One after the other: each force, then its moves.
  const std::vector<Estimate> flat =
      kept_.get(question, 2 * calibration_.data.size() * (1 + moved), [&] {
        const Stopwatch watch(corrected ? good_seconds_ : fast_seconds_);
        std::vector<Estimate> out;
        const auto add = [&](const Force& force) {
          out.push_back(force.estimate);
          for (const double move : force.moves) out.push_back({move, 0});
        };
        for (const Friction& f : evaluated(finger, sampling, corrected)) {
          add(f.off);
          add(f.on);
        }
        return out;
      });
  PAPILLA_CHECK(flat.size() == 2 * calibration_.data.size() * (1 + moved),
                "every skin is left out once");
  auto next = flat.begin();
  const auto take = [&] {
    Force out{*next++, {}};
    for (std::size_t k = 0; k < moved; ++k) out.moves.push_back((next++)->value);
    return out;
  };
  std::vector<Friction> out(calibration_.data.size());
  for (Friction& f : out) {
    f.off = take();
    f.on = take();
  }
  return out;
}

std::vector<Residuals::Friction> Residuals::evaluated(const Finger& finger,
                                                      const SkinSampling& sampling,
                                                      bool corrected) const {
  Fidelity fidelity = sampling.fidelity(threads_);
  if (corrected) fidelity.control_skins = fidelity_level(sampling.level).control_skins;
  std::vector<Friction> out(calibration_.data.size());
  for (const MeasuredGroup& s : groups_) {
    Scene scene = scene_of(s.design);
    scene.finger = finger.touching_as(scene.finger);
    scene.model = finger.calibrated_for;
    const Response response = evaluate(scene, s.design.texture, fidelity);
    for (std::size_t k = 0; k < s.rows.size(); ++k) {
      const std::size_t at = s.humidity_of[k];
      const auto force = [&](Measured PointQuantities::*of) {
        const Measured& here = response.points[at].*of;
        std::vector<double> without;
        for (const auto& points : response.without) without.push_back((points[at].*of).value);
        Force found{{here.value, here.parts.sampling}, {}};
        if (!without.empty()) found.moves = error_moves(jackknife_samples(here.value, without));
        return found;
      };
      out[s.rows[k]] = {force(&PointQuantities::friction_off),
                        force(&PointQuantities::friction_on)};
    }
  }
  return out;
}

void Residuals::group_data() {
  using Key = std::tuple<std::string, double, double, double, std::optional<FingerState>>;
  std::map<Key, std::vector<std::size_t>> same;
  for (std::size_t i = 0; i < calibration_.data.size(); ++i) {
    const FrictionDatum& d = calibration_.data[i];
    same[{d.design, d.amplitude, d.frequency, d.load, d.state}].push_back(i);
  }
  for (const auto& [key, rows] : same) {
    const FrictionDatum& d = calibration_.data[rows.front()];
    MeasuredGroup s{as_measured(read_design(d.design), d), rows, {}};
    std::set<double> humidities;
    for (std::size_t i : rows) humidities.insert(calibration_.data[i].relative_humidity);
    s.design.environment.relative_humidity.assign(humidities.begin(), humidities.end());
    s.design.environment.weights.clear();
    for (std::size_t i : rows) {
      const auto at = humidities.find(calibration_.data[i].relative_humidity);
      s.humidity_of.push_back(static_cast<std::size_t>(std::distance(humidities.begin(), at)));
    }
    groups_.push_back(std::move(s));
  }
}

}  // namespace papilla::calibrate
