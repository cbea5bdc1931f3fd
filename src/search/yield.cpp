#include "search/yield.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <deque>
#include <optional>
#include <variant>

#include "base/constants.h"
#include "numerics/statistics.h"
#include "search/risk.h"

namespace papilla::search {
namespace {

// Sequences of plates that are independent of each other: their spread is the error of the share.
constexpr std::size_t kSequences = 8;

using Deviations = std::vector<std::vector<double>>;

// What an evaluation says of the limits, over the scatter: of each task as drawn a quadratic of
// each number. Eq. search.10
class LimitedOverScatter {
 public:
  LimitedOverScatter(const Scoring& scoring, const Score& score, bool looks) : scoring_(scoring) {
    const std::size_t count = scoring.law.size();
    for (std::size_t t = 0; t < scoring.nominal; ++t) {
      const auto quadratic = [&](const auto& number) {
        std::vector<double> lower, upper;
        for (std::size_t k = 0; k < count; ++k) {
          const std::size_t low = scoring.nominal + 2 * (t * count + k);
          lower.push_back(number(score.by_task.at(low)));
          upper.push_back(number(score.by_task.at(low + 1)));
        }
        return ScatterQuadratic(number(score.by_task.at(t)), lower, upper);
      };
      const LimitedNumbers& drawn = score.by_task.at(t);
      Task task{quadratic([](const LimitedNumbers& n) { return 1 / n.oxide_margin; }), {}, {}, {}};
      for (std::size_t j = 0; j < drawn.limited.size(); ++j)
        task.limited.push_back(quadratic([j](const LimitedNumbers& n) { return n.limited[j]; }));
      task.errors = drawn.limited_errors;
      for (double Look::*number : kLookNumbers) {
        if (looks && !drawn.looks.empty())
          task.look.push_back(
              quadratic([number](const LimitedNumbers& n) { return n.looks.front().*number; }));
      }
      tasks_.push_back(std::move(task));
    }
  }

  // Over all tasks, of a plate.
  LimitedNumbers at(const std::vector<double>& deviation) const {
    std::vector<LimitedNumbers> all;
    for (const Task& task : tasks_) {
      LimitedNumbers& n = all.emplace_back();
      const double field = task.field.at(deviation);
      n.oxide_margin = field > 0 ? 1 / field : kInfinity;
      for (const ScatterQuadratic& q : task.limited) n.limited.push_back(q.at(deviation));
      n.limited_errors = task.errors;
      if (task.look.empty()) continue;
      Look& look = n.looks.emplace_back();
      for (std::size_t i = 0; i < kLookNumbers.size(); ++i)
        look.*kLookNumbers[i] = task.look[i].at(deviation);
    }
    return bad_side(scoring_, all);
  }

 private:
  struct Task {
    ScatterQuadratic field;  // over the strength of the dielectric: 0 without a field
    std::vector<ScatterQuadratic> limited, look;
    std::vector<double> errors;
  };
  const Scoring& scoring_;
  std::vector<Task> tasks_;
};

// How plates keep the limits: by the limited metrics as they are, and one standard error of each
// off either way.
struct Verdicts {
  std::vector<char> kept, if_better, if_worse;
  std::vector<std::size_t> broken;  // of each limit of the study: plates
  std::size_t not_makeable = 0;
};

class PlateJudge {
 public:
  PlateJudge(const Study& study, const StudyConstraints& constraints, const Scoring& scoring,
             const Design& design, const Score& score)
      : study_(study),
        constraints_(constraints),
        goals_(scoring.goals),
        quick_looks_(!constraints.in_look().empty()),
        plates_(study, design),
        over_scatter_(scoring, score, !quick_looks_) {
    if (!quick_looks_) return;
    for (const Design& d : constraints.looked_at(design)) looked_at_.emplace_back(study, d);
  }

  // scale: of each tolerance.
  Verdicts judge(const Deviations& deviations, const std::vector<double>& scale) {
    Verdicts out;
    out.broken.assign(study_.constraints.size(), 0);
    for (std::vector<double> u : deviations) {
      for (std::size_t k = 0; k < u.size(); ++k) u[k] *= scale[k];
      const Design& plate = plates_.plate(u);
      if (design_problems(plate).empty()) {
        LimitedNumbers numbers = over_scatter_.at(u);
        for (Plates& of : looked_at_) numbers.looks.push_back(appearance_of(of.plate(u)));
        add(plate, numbers, out);
      } else {
        ++out.not_makeable;
        for (std::vector<char>* list : {&out.kept, &out.if_better, &out.if_worse})
          list->push_back(false);
      }
    }
    return out;
  }

 private:
  void add(const Design& plate, const LimitedNumbers& numbers, Verdicts& out) const {
    bool kept = true, better = true, worse = true;
    for (std::size_t i = 0; i < study_.constraints.size(); ++i) {
      const Constraint& limit = study_.constraints[i];
      if (std::holds_alternative<YieldLimit>(limit.on)) continue;
      const double value = constraints_.value(limit, plate, numbers);
      const auto* metric = std::get_if<MetricLimit>(&limit.on);
      const double error = metric ? numbers.limited_errors[goals_.place_of(*metric)] : 0;
      const double up = limit.at_least ? error : -error;
      const bool keeps_it = keeps(limit, value);
      out.broken[i] += !keeps_it;
      kept = kept && keeps_it;
      better = better && keeps(limit, value + up);
      worse = worse && keeps(limit, value - up);
    }
    out.kept.push_back(kept);
    out.if_better.push_back(better);
    out.if_worse.push_back(worse);
  }

  const Study& study_;
  const StudyConstraints& constraints_;
  const StudyGoals& goals_;
  bool quick_looks_;
  Plates plates_;
  std::deque<Plates> looked_at_;  // where looks are known without an evaluation: in each scenario
  LimitedOverScatter over_scatter_;
};

bool limits_look(const Study& study) {
  return std::any_of(study.constraints.begin(), study.constraints.end(),
                     [](const Constraint& c) { return std::holds_alternative<LookLimit>(c.on); });
}

// Every sequence in turn.
Deviations deviations_of(const Study& study, const ScatterLaw& law, std::size_t plates) {
  const auto first = kSequences * static_cast<std::uint64_t>(study.search.seed);
  Deviations out;
  for (std::size_t i = 0; i < plates; ++i)
    out.push_back(law.plate(first + i % kSequences, i / kSequences));
  return out;
}

// Of plates that keep the limits; before: less those that did. Its error by the sequences.
YieldShare share_of(const std::vector<char>& kept, const std::vector<char>* before = nullptr) {
  std::vector<double> sums(kSequences, 0), counts(kSequences, 0);
  for (std::size_t i = 0; i < kept.size(); ++i) {
    sums[i % kSequences] += kept[i] - (before ? (*before)[i] : 0);
    ++counts[i % kSequences];
  }
  for (std::size_t r = 0; r < kSequences; ++r) sums[r] /= counts[r];
  const Estimate mean = mean_estimate(sums);
  return {mean.value, mean.se};
}

// With what the errors of the limited metrics leave open.
YieldShare share_of(const Verdicts& v) {
  YieldShare out = share_of(v.kept);
  const double open = 0.5 * (share_of(v.if_better).share - share_of(v.if_worse).share);
  out.error = std::hypot(out.error, open);
  return out;
}

}  // namespace

std::size_t plates_of(const Study& study, bool confirmed) {
  return confirmed && !limits_look(study) ? kPlates : kFewPlates;
}

double yield_price(const Study& study, std::size_t looks, std::size_t searched,
                   std::size_t confirmed) {
  constexpr double kPlate = 1e-5, kLook = 1e-3;  // [s]
  if (!YieldModel::exists(study)) return 0;
  const bool limited =
      std::any_of(study.constraints.begin(), study.constraints.end(),
                  [](const Constraint& c) { return std::holds_alternative<YieldLimit>(c.on); });
  std::size_t plates = plates_of(study, true) * (1 + study.scatter.size());  // of what is built
  if (limited) plates += searched * kFewPlates + confirmed * plates_of(study, true);
  return static_cast<double>(plates) * (looks > 0 ? static_cast<double>(looks) * kLook : kPlate);
}

std::optional<std::size_t> Yield::costliest() const {
  const auto most =
      std::max_element(halved.begin(), halved.end(),
                       [](const YieldShare& a, const YieldShare& b) { return a.share < b.share; });
  if (most == halved.end() || !(most->share > most->error)) return std::nullopt;
  return static_cast<std::size_t>(most - halved.begin());
}

bool YieldModel::exists(const Study& study) {
  return !study.scatter.empty() &&
         std::any_of(study.constraints.begin(), study.constraints.end(),
                     [](const Constraint& c) { return !std::holds_alternative<YieldLimit>(c.on); });
}

YieldShare YieldModel::share(const Design& design, const Score& score, std::size_t plates) const {
  PlateJudge judge(study_, constraints_, scoring_, design, score);
  return share_of(judge.judge(deviations_of(study_, scoring_.law, plates),
                              std::vector<double>(scoring_.law.size(), 1)));
}

Yield YieldModel::yield(const Design& design, const Score& score, std::size_t plates) const {
  constexpr double kTightened = 0.5;
  PlateJudge judge(study_, constraints_, scoring_, design, score);
  const Deviations deviations = deviations_of(study_, scoring_.law, plates);
  std::vector<double> scale(scoring_.law.size(), 1);
  const Verdicts now = judge.judge(deviations, scale);
  Yield out;
  out.plates = plates;
  out.now = share_of(now);
  const auto all = static_cast<double>(plates);
  for (const std::size_t broken : now.broken)
    out.broken.push_back(static_cast<double>(broken) / all);
  out.not_makeable = static_cast<double>(now.not_makeable) / all;
  for (double& one : scale) {
    one = kTightened;
    out.halved.push_back(share_of(judge.judge(deviations, scale).kept, &now.kept));
    one = 1;
  }
  return out;
}

}  // namespace papilla::search
