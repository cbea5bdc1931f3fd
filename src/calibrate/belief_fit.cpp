#include "calibrate/belief_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/units.h"
#include "base/watch.h"
#include "forward/plan.h"

namespace papilla::calibrate {
namespace {

// At most.
int evaluations_of_one(const Calibration& c) {
  const int an_iteration = 2 * static_cast<int>(c.parameters.size()) + 1;
  return c.belief->starts * c.belief->iterations * an_iteration + c.belief->samples;
}

class BeliefMaker {
 public:
  BeliefMaker(const Calibration& calibration, Residuals& residuals, const LeastSquaresFit& fit,
              const Finger& finger, const std::vector<PosteriorTrial>& trials,
              const std::function<void(const std::string&)>& note)
      : calibration_(calibration),
        settings_(*calibration.belief),
        residuals_(residuals),
        fit_(fit),
        finger_(finger),
        trials_(trials),
        note_(note),
        parameters_(fit_parameters(calibration)) {
    sources_ = residuals.sources();
    for (const std::string& source : sources_) {
      if (std::find(out_.groups.begin(), out_.groups.end(), source) == out_.groups.end())
        out_.groups.push_back(source);
    }
  }

  BeliefFit make() {
    const std::vector<FitRow> rows = residuals_.rows();
    sample({settings_.name, {}, {}}, true);
    for (const Hypothesis& h : calibration_.hypotheses) sample(h, false);
    residuals_.rows() = rows;
    weigh();
    choose();
    return std::move(out_);
  }

 private:
  void note(const std::string& text) const {
    if (note_) note_(text);
  }

  void sample(const Hypothesis& hypothesis, bool own) {
    HypothesisFit& out = out_.hypotheses.emplace_back();
    out.name = hypothesis.name;
    try {
      const Calibration calibration = own ? calibration_ : under(calibration_, hypothesis);
      PosteriorOptions options;
      options.starts = settings_.starts;
      options.samples = settings_.samples;
      options.seed = static_cast<std::uint64_t>(settings_.seed);
      options.fit.iterations = settings_.iterations;
      options.fit.noise = 1e-6;  // as the fit's own
      options.fit.tolerance = 1e-4;
      options.fit.profile_iterations = 0;
      options.note = [&](const std::string& text) { note(hypothesis.name + ": " + text); };
      if (!own) weigh_rows(calibration);
      options.bands = residuals_.bands();
      options.common = residuals_.common();
      options.groups = groups();
      if (!own) options.variance_factor = out_.hypotheses.front().posterior.variance_factor;
      const int most = evaluations_of_one(calibration);
      const auto begin = std::chrono::steady_clock::now();
      int said = 0;
      const auto answers = [&](std::span<const double> p, std::span<double> r) {
        const std::vector<Estimate> model = residuals_.model(calibration, p);
        Watch::look();
        if (++said % kEvaluationsANote == 0) {
          const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin;
          note(fmt::format("{} ({} of {}): evaluation {}; {} at most to its last", hypothesis.name,
                           out_.hypotheses.size(), 1 + calibration_.hypotheses.size(), said,
                           duration(spent.count() / said * std::max(0, most - said))));
        }
        return residuals_.answers(model, r);
      };
      const std::vector<FitParameter> parameters = fit_parameters(calibration);
      out.posterior =
          own ? sample_posterior(parameters, residuals_.size(), answers, options, &fit_, trials_)
              : sample_posterior(parameters, residuals_.size(), answers, options);
      out_.evaluations += out.posterior.evaluations;
      std::vector<double> log_sd(out_.groups.size(), 0);
      for (std::size_t i = 0; i < sources_.size(); ++i)
        log_sd[group(i)] += std::log(residuals_.rows()[i].own_deviation());
      log_sd_.push_back(std::move(log_sd));
    } catch (const InputError& error) {
      if (own) throw;  // nothing would be left
      out.failed = error.problems().empty() ? error.what() : error.problems().front().message;
      log_sd_.emplace_back();
      note(hypothesis.name + " has no answer: " + out.failed);
    }
  }

  // The model's own sampling error, at the hypothesis' start.
  void weigh_rows(const Calibration& calibration) {
    std::vector<double> start;
    for (const CalibrationParameter& p : calibration.parameters) start.push_back(p.fit.start);
    residuals_.correct(calibration, start);
    const int all = 2 * static_cast<int>(start.size());
    if (const double each = residuals_.seconds_a_factor(); each > 0)
      note(fmt::format("the correction at its start: {} evaluations, {}", all,
                       duration(each * all)));
    residuals_.follow(calibration, start, [](int) { Watch::look(); });
    residuals_.weigh(calibration, start);
  }

  std::size_t group(std::size_t row) const {
    return static_cast<std::size_t>(
        std::find(out_.groups.begin(), out_.groups.end(), sources_[row]) - out_.groups.begin());
  }

  std::vector<std::vector<std::size_t>> groups() const {
    std::vector<std::vector<std::size_t>> out(out_.groups.size());
    for (std::size_t i = 0; i < sources_.size(); ++i) out[group(i)].push_back(i);
    return out;
  }

  // Of the best fit or sample. Eq. calibration.2
  double own_factor(const Posterior& posterior) const {
    return fit_.degrees_of_freedom > 0
               ? std::max(1.0, posterior.least_sum / fit_.degrees_of_freedom)
               : 1;
  }

  // All by the variance factor of the one that explains the data best. Eq. calibration.9
  void weigh() {
    double factor = std::numeric_limits<double>::infinity();
    for (const HypothesisFit& h : out_.hypotheses) {
      if (h.failed.empty()) factor = std::min(factor, own_factor(h.posterior));
    }
    out_.variance_factor = factor;
    std::vector<LeftOut> scores;
    for (std::size_t k = 0; k < out_.hypotheses.size(); ++k) {
      HypothesisFit& h = out_.hypotheses[k];
      if (!h.failed.empty()) continue;
      reweigh(h.posterior, factor);
      scores.push_back(leave_out(h.posterior, log_sd_[k]));
      const LeftOut& left = scores.back();
      h.scores = left.scores;
      h.least_effective = left.least_effective;
      for (std::size_t g = 0; g < left.scores.size(); ++g) {
        h.score += left.scores[g];
        h.score_error = std::hypot(h.score_error, left.errors[g]);
      }
    }
    const std::vector<double> weights =
        hypothesis_weights(scores, static_cast<std::uint64_t>(settings_.seed));
    std::size_t next = 0;
    for (HypothesisFit& h : out_.hypotheses) {
      if (!h.failed.empty()) continue;
      h.weight = weights[next++];
      note(fmt::format(
          "{}: weight {:.3f}, log predictive score {:.2f} ± {:.2f}, {} samples, "
          "guessed to {:.2f} of their own error",
          h.name, h.weight, h.score, h.score_error, h.posterior.asked, h.posterior.guess_error));
    }
  }

  double coordinate(std::size_t parameter, double value) const {
    return parameters_[parameter].logarithmic ? std::log(value) : value;
  }

  // Members of all samples, alike in every row and parameter. Eq. calibration.10
  void choose() {
    std::vector<std::vector<double>> features;
    std::vector<double> weights;
    std::vector<int> stratum;
    std::vector<const PosteriorSample*> samples;
    for (std::size_t k = 0; k < out_.hypotheses.size(); ++k) {
      const HypothesisFit& h = out_.hypotheses[k];
      for (const PosteriorSample& s : h.posterior.samples) {
        if (!(h.weight * s.weight > 0)) continue;
        std::vector<double> feature;
        for (const double answer : s.answers) feature.push_back(compressed(answer));
        for (std::size_t i = 0; i < s.values.size(); ++i)
          feature.push_back(coordinate(i, s.values[i]));
        features.push_back(std::move(feature));
        weights.push_back(h.weight * s.weight);
        stratum.push_back(static_cast<int>(k));
        samples.push_back(&s);
      }
    }
    const ChosenPoints chosen = choose_points(features, weights, stratum, settings_.members,
                                              static_cast<std::uint64_t>(settings_.seed));
    out_.largest_mean = chosen.largest_mean;
    out_.least_spread = chosen.least_spread;
    out_.largest_spread = chosen.largest_spread;
    Belief& b = out_.belief;
    b.made_of = fmt::format("papilla calibrate, {} rows, {} hypotheses", residuals_.size(),
                            out_.hypotheses.size());
    for (const HypothesisFit& h : out_.hypotheses) b.samples += h.posterior.asked;
    b.effective_samples = effective_number(weights);
    for (const FrictionDatum& d : calibration_.data)
      b.readings.push_back(
          reading_text(d.load, d.relative_humidity, d.amplitude, d.off, d.on_sd > 0 ? d.on : 0));
    b.calibrated_for = finger_.calibrated_for;
    b.fitted = values(fit_.values());
    for (std::size_t k = 0; k < chosen.index.size(); ++k) {
      const auto of = static_cast<std::size_t>(stratum[chosen.index[k]]);
      BeliefMember member{chosen.weight[k], out_.hypotheses[of].name,
                          values(samples[chosen.index[k]]->values)};
      if (of > 0) {
        for (const BeliefValue& v : calibration_.hypotheses[of - 1].set) member.set.push_back(v);
      }
      b.members.push_back(std::move(member));
    }
  }

  std::vector<BeliefValue> values(const std::vector<double>& si) const {
    std::vector<BeliefValue> out;
    for (std::size_t i = 0; i < si.size(); ++i) {
      const CalibrationParameter& p = calibration_.parameters[i];
      Node node = p.unit.empty() ? number_node(si[i]) : text_node(format_quantity(si[i], p.unit));
      out.push_back({p.path, std::move(node)});
    }
    return out;
  }

  const Calibration& calibration_;
  const BeliefSettings& settings_;
  Residuals& residuals_;
  const LeastSquaresFit& fit_;
  const Finger& finger_;
  const std::vector<PosteriorTrial>& trials_;
  std::function<void(const std::string&)> note_;
  std::vector<FitParameter> parameters_;
  std::vector<std::string> sources_;         // of each row
  std::vector<std::vector<double>> log_sd_;  // [hypothesis][group]
  BeliefFit out_;
};

}  // namespace

int belief_evaluations(const Calibration& calibration) {
  if (!calibration.belief) return 0;
  return evaluations_of_one(calibration) * (1 + static_cast<int>(calibration.hypotheses.size()));
}

BeliefFit make_belief(const Calibration& calibration, Residuals& residuals,
                      const LeastSquaresFit& fit, const Finger& finger,
                      const std::vector<PosteriorTrial>& trials,
                      const std::function<void(const std::string&)>& note) {
  return BeliefMaker(calibration, residuals, fit, finger, trials, note).make();
}

}  // namespace papilla::calibrate
