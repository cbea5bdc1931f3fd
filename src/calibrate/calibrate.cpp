#include "calibrate/calibrate.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <tuple>
#include <utility>

#include "base/constants.h"
#include "base/units.h"
#include "base/watch.h"
#include "config/describe.h"
#include "design/design.h"
#include "forward/forward.h"
#include "forward/plan.h"
#include "optim/posterior_guess.h"
#include "published/targets.h"

namespace papilla::calibrate {
namespace {

// Fits with the correction to the fine level taken anew, and the change of a friction below which
// it is good enough, in standard deviations of the datum.
constexpr int kMostRounds = 3;
constexpr double kSmallCorrection = 0.25;

// A chi squared per degree of freedom beyond which the fit says nothing about the finger: misses of
// four standard deviations each.
constexpr double kPoorFit = 16;

double sum_of_squares(std::span<const double> r) {
  double sum = 0;
  for (double v : r) sum += v * v;
  return sum;
}

LeastSquaresOptions fit_options(const Calibration& calibration) {
  LeastSquaresOptions fit;
  fit.iterations = calibration.iterations;
  fit.noise = 1e-6;  // of the contact solves; each parameter has its own step all the same
  fit.tolerance = 1e-4;
  fit.profiles = calibration.profiles;
  fit.profile_iterations = 4;
  return fit;
}

// The friction coefficient on flat glass without voltage, at each humidity of that sample.
std::vector<double> flat_glass_friction(const Finger& finger, const Fidelity& fidelity) {
  Design flat = read_design(find_design("m3_samples/flat.toml"));
  flat.finger = finger.touching_as(flat.finger);
  flat.model = finger.calibrated_for;
  std::vector<double> out;
  for (const ResponsePoint& p : evaluate(scene_of(flat), flat.texture, fidelity).points)
    out.push_back(p.friction_off.value / flat.finger.load);
  return out;
}

class Fit {
 public:
  Fit(const Calibration& calibration, const CalibrationOptions& options)
      : calibration_(calibration),
        options_(options),
        residuals_(calibration, options.threads, options.folder),
        parameters_(fit_parameters(calibration)) {}

  CalibrationResult run() {
    if (const int known = residuals_.kept().known(); known > 0)
      note(fmt::format("goes on: {} answers of the model are kept in {}", known,
                       residuals_.kept().file()));
    start();
    descend();
    finish();
    if (calibration_.belief) {
      out_.belief =
          make_belief(calibration_, residuals_, out_.fit, out_.finger, trials_, options_.note);
      out_.evaluations += out_.belief->evaluations;
    }
    residuals_.kept().remove();
    return std::move(out_);
  }

 private:
  void note(const std::string& text) const {
    if (options_.note) options_.note(text);
  }

  // The rows of the finger that the fit starts from; their sampling error stays in the weights.
  void start() {
    std::vector<double> values;
    for (const FitParameter& p : parameters_) values.push_back(p.start);
    out_.start = with_parameters(calibration_, values);
    std::vector<FitRow>& rows = residuals_.rows();
    note(fmt::format("{} residuals, {} parameters; the first evaluation tells the price",
                     rows.size(), parameters_.size()));
    residuals_.correct(calibration_, values);
    const std::vector<Estimate> before = residuals_.weigh(calibration_, values);
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i].before = before[i].value;
    state_price();
    follow(values);
    std::vector<double> r(rows.size());
    residuals_.residuals(calibration_, values, r);
    out_.chi2_before = sum_of_squares(r);
    note(fmt::format("chi2 {:.4g} at the start", out_.chi2_before));
  }

  // At most, as far as the answers of the model are not kept from before.
  void state_price() const {
    const double each = residuals_.seconds_a_model(), corrected = residuals_.seconds_a_factor();
    if (!(each > 0)) return;
    const double rounds = corrections() * corrected,
                 fit = each * an_iteration() * calibration_.iterations;
    std::string text = fmt::format("price: {} an evaluation", duration(each));
    if (rounds > 0)
      text += fmt::format(", {} with the level of the checks; {} of those first, {}",
                          duration(corrected), corrections(), duration(rounds));
    text += fmt::format("; the fit {} at most ({} iterations of {}){}", duration(fit),
                        calibration_.iterations, an_iteration(),
                        calibration_.profiles ? ", and profiles after it" : "");
    double all = rounds + fit;
    if (calibration_.belief) {
      const double belief = belief_evaluations(calibration_) * each +
                            (1.0 + static_cast<double>(calibration_.hypotheses.size())) * rounds;
      text += fmt::format("; the belief {} at most", duration(belief));
      all += belief;
    }
    note(text +
         fmt::format("; all {} at most{}, and more (up to {} times) where the finger moves far. "
                     "Ctrl-C keeps what is done",
                     duration(all), calibration_.profiles ? " without the profiles" : "",
                     kMostRounds));
  }

  // Evaluations of both levels that the correction and its slopes take, at one place.
  int corrections() const { return calibration_.data.empty() ? 0 : an_iteration(); }

  // Says how far it is.
  void follow(const std::vector<double>& values) {
    const int all = 2 * static_cast<int>(parameters_.size());
    residuals_.follow(calibration_, values, [&](int done) {
      Watch::look();
      if (done % kEvaluationsANote != 0 && done != all) return;
      note(fmt::format("correction: {} of {} evaluations, {} left", done, all,
                       duration(residuals_.seconds_a_factor() * (all - done))));
    });
  }

  int an_iteration() const { return 2 * static_cast<int>(parameters_.size()) + 1; }

  // Where the fitted finger is far from the start the correction is another: again from there.
  void descend() {
    out_.iterations = calibration_.iterations;
    for (int round = 1;; ++round) {
      fit_once();
      const std::vector<double> found = out_.fit.values();
      if (residuals_.correct(calibration_, found) < kSmallCorrection || round == kMostRounds) break;
      follow(found);
      note("frictions of the fine level have moved: fitted again from here");
      for (std::size_t i = 0; i < found.size(); ++i) parameters_[i].start = found[i];
    }
    if (calibration_.data.empty() || !calibration_.belief) return;
    // Samples go farther than fits: by the correction here and how it moves from here.
    residuals_.correct(calibration_, out_.fit.values());
    follow(out_.fit.values());
    trials_.clear();  // of other corrections
  }

  // By the correction as it is.
  void fit_once() {
    in_descent_ = 0;
    trials_.clear();  // of other corrections
    PosteriorOptions rows;
    rows.bands = residuals_.bands();
    rows.common = residuals_.common();
    const auto misses = [&](std::span<const double> p, std::span<double> r) {
      const bool ok = residuals_.answers(calibration_, p, r);
      Watch::look();
      if (ok) trials_.push_back({{p.begin(), p.end()}, {r.begin(), r.end()}});
      take_bands_off(r, rows.bands);
      rows.common.whiten(r);
      if (++evaluations_ % kEvaluationsANote == 0)
        note(fmt::format("evaluation {}: chi2 {:.4g}; {}", evaluations_, sum_of_squares(r),
                         time_left()));
      ++in_descent_;
      return ok;
    };
    profiles_ = {};
    LeastSquaresOptions options = fit_options(calibration_);
    options.walks_profiles = [&](const LeastSquaresFit& fit) { return walks_profiles(fit); };
    options.directions = [&](const std::vector<double>& values, const LeastSquaresFit& fit) {
      return directions_by_trials(parameters_, trials_, rows, values, fit);
    };
    options.note = [&](const std::string& text) {
      if (profiles_.begun == 0) profiles_.since = std::chrono::steady_clock::now();
      note(fmt::format("{}, {} of {}", text, ++profiles_.begun, profiles_.wanted));
    };
    out_.fit = least_squares(parameters_, residuals_.size(), misses, options);
  }

  // Profiles cost many times the descent, so what is wrong with the data is said before them, and a
  // finger that explains nothing has none.
  bool walks_profiles(const LeastSquaresFit& fit) {
    out_.fit = fit;
    std::vector<FitRow>& rows = residuals_.rows();
    const std::vector<double> misses = residuals_.misses(fit.residuals);
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i].miss = misses[i];
    note(fmt::format("chi2 {:.4g} after the descent; {}", fit.chi2, worst_miss_text(rows)));
    profiles_.wanted = static_cast<int>(
        std::count_if(fit.parameters.begin(), fit.parameters.end(),
                      [&](const ParameterFit& p) { return calibration_.profiles || p.at_bound; }));
    if (profiles_.wanted == 0) return false;
    if (explains_data(out_)) return true;
    if (!std::exchange(said_without_profiles_, true))
      note(
          fmt::format("profiles are not walked: chi2 per degree of freedom is {:.3g}, beyond "
                      "{:g}, and intervals of a finger that does not explain the data say nothing",
                      misfit(out_), kPoorFit));
    return false;
  }

  // Of the descent by what it may take, of the profiles by what those before took.
  std::string time_left() const {
    if (profiles_.begun == 0) {
      const int left = std::max(0, an_iteration() * calibration_.iterations - in_descent_);
      return fmt::format("{} at most to the last iteration",
                         duration(residuals_.seconds_a_model() * left));
    }
    const std::string which = fmt::format("profile {} of {}", profiles_.begun, profiles_.wanted);
    if (profiles_.begun == 1) return which + ", whose time is known after the first";
    const double taken =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - profiles_.since).count();
    // Of those that are done and the one that is under way, half of it.
    const double each = taken / (profiles_.begun - 0.5);
    return fmt::format("{}, about {} left", which,
                       duration(each * (profiles_.wanted - profiles_.begun + 0.5)));
  }

  void finish() {
    out_.finger = with_parameters(calibration_, out_.fit.values());
    // What no fit has moved keeps its name.
    if (!calibration_.title.empty() && calibration_.iterations > 0)
      out_.finger.name = calibration_.title;
    out_.finger.fitted_to.clear();
    for (const std::string& id : calibration_.fit)
      out_.finger.fitted_to += (out_.finger.fitted_to.empty() ? "" : " ") + id;
    out_.finger.uncertainty = deviations(out_.fit, options_.note);
    out_.rows = residuals_.rows();
    const std::vector<Estimate> after = residuals_.model(calibration_, out_.fit.values());
    std::vector<double> misses(after.size());
    residuals_.answers(after, misses);
    take_bands_off(misses, residuals_.bands());
    const CommonErrors common = residuals_.common();
    for (std::size_t i = 0; i < after.size(); ++i) {
      out_.rows[i].after = after[i].value;
      out_.rows[i].miss = misses[i] / common.deviation(i);
      out_.rows[i].deviation = out_.rows[i].own_deviation() * common.deviation(i);
    }
    std::tie(out_.least_factor, out_.largest_factor) =
        residuals_.factors_between(calibration_, out_.fit.values());
    // The start, its skins, and the fitted finger.
    out_.evaluations = evaluations_ + 2 + !calibration_.data.empty();
    out_.gap_before = capacitance_gap(out_.start);
    out_.gap_after = capacitance_gap(out_.finger);
    if (options_.check) {
      out_.friction_coefficient =
          flat_glass_friction(out_.finger, calibration_.check.fidelity(options_.threads));
    }
  }

  const Calibration& calibration_;
  const CalibrationOptions& options_;
  Residuals residuals_;
  std::vector<FitParameter> parameters_;
  CalibrationResult out_;
  std::vector<PosteriorTrial> trials_;
  int evaluations_ = 0, in_descent_ = 0;
  bool said_without_profiles_ = false;
  struct {
    int begun = 0, wanted = 0;
    std::chrono::steady_clock::time_point since{};  // the first began
  } profiles_;
};

}  // namespace

std::vector<ParameterDeviation> deviations(const LeastSquaresFit& fit,
                                           const std::function<void(const std::string&)>& note) {
  // That a finger file takes; whoever has more is not known at all.
  ParameterDeviation row;
  const NumberField key = find_number(row, "deviation");
  const double most = key.high * find_unit(key.unit)->to_si;
  std::vector<ParameterDeviation> out;
  std::vector<std::size_t> known;
  const std::size_t n = fit.parameters.size();
  for (std::size_t i = 0; i < n; ++i) {
    const ParameterFit& f = fit.parameters[i];
    if (f.at_bound || !(f.se > 0) || !std::isfinite(f.se)) continue;
    const double relative = f.value != 0 ? f.se / std::abs(f.value) : kInfinity;
    if (relative > most && note)
      note(
          fmt::format("{} is not known: its standard error is {}; the finger's file says {:g} %, "
                      "the most that it takes",
                      f.name,
                      f.value != 0 ? fmt::format("{:.3g} % of it", 100 * relative)
                                   : std::string("beside a value of 0"),
                      100 * most));
    row = {f.name, std::min(relative, most), {}};
    for (const std::size_t j : known) row.correlation.push_back(fit.correlation[i * n + j]);
    known.push_back(i);
    out.push_back(row);
  }
  return out;
}

CalibrationResult fit_finger(const Calibration& calibration, const CalibrationOptions& options) {
  return Fit(calibration, options).run();
}

double misfit(const CalibrationResult& result) {
  return result.fit.chi2 / std::max(1, result.fit.degrees_of_freedom);
}

bool explains_data(const CalibrationResult& result) { return !(misfit(result) > kPoorFit); }

}  // namespace papilla::calibrate
