// Planted truths: how many measurements find the right hypothesis, halve the interval of a decision
// and find an error of the model; by chosen experiments, by D-optimal ones and by a grid, and how
// few any plan could take. Markdown on standard output.
//   lab_bench FOLDER [MEMBERS TRUTHS]
//                    FOLDER keeps what the model has answered; MEMBERS are drawn about the
//                    reference finger, TRUTHS anew and evaluated each by itself at the designs' own
//                    level, on other skins
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <numeric>
#include <sstream>
#include <string>
#include <vector>

#include "base/constants.h"
#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "bench/drawn_belief.h"
#include "config/writer.h"
#include "estimate/belief.h"
#include "forward/forward.h"
#include "lab/evidence.h"
#include "lab/planning.h"
#include "numerics/statistics.h"
#include "optim/unfinished.h"

using namespace papilla::tests;

namespace {

constexpr int kTruthSeed = 3000;  // of the skins of the truths
// Touches a day; those after which a plan is judged, and those that it makes at most.
constexpr int kRound = 6, kWanted = 30, kMost = 72;
constexpr std::size_t kScatters = 2;  // how often each truth is measured, with other scatter
constexpr double kSmallLoss = 0.02;   // of the choice: what a plan is to come under
const std::vector<std::string> kDesigns{"a3h350", "a3h600", "a3h900", "a4h350", "a4h600", "flat"};
const std::vector<std::string> kHypotheses{"air ionises", "air breaks down by field alone"};

// Numbers of the finger times exp(s normal): skin, load, layer, water; every second by another
// hypothesis.
Belief drawn(const Finger& finger, int members, const char* purpose) {
  DrawnBelief out("lab_bench", finger, purpose);
  for (int m = 0; m < members; ++m) {
    BeliefMember& member = out.add(1.0 / members, 0.3, true);
    member.hypothesis = kHypotheses[static_cast<std::size_t>(m) % kHypotheses.size()];
    if (m % 2 == 1) member.set.push_back({"model.air_limit", text_node("emission")});
  }
  return out.take();
}

// What a reading would be of, without scatter [N].
struct Friction {
  double off = 0, on = 0;
};

struct World {
  LabFile file;
  std::vector<LabDesign> designs;
  std::vector<Experiment> experiments;
  std::unique_ptr<MemberModel> model;
  std::unique_ptr<ResponseTable> table;
  std::vector<MemberNumbers> worth;  // of the designs
  // Truths, [experiment][truth] and [design][truth].
  std::vector<std::vector<Friction>> truth;
  std::vector<std::vector<double>> truth_worth;

  std::size_t index(const Experiment& e) const {
    return static_cast<std::size_t>(std::find(experiments.begin(), experiments.end(), e) -
                                    experiments.begin());
  }
};

// Of each truth, off and on.
std::string frictions_text(const Design& design, const Belief& truths) {
  Fidelity fidelity = fidelity_of(design);
  fidelity.threads = 1;
  const std::vector<Scene> scenes = belief_scenes(truths, scene_of(design));
  std::vector<std::string> out(scenes.size());
  parallel_for(
      static_cast<int>(scenes.size()),
      [&](int k) {
        const auto t = static_cast<std::size_t>(k);
        const ResponsePoint p = evaluate(scenes[t], design.texture, fidelity).points.front();
        out[t] = fmt::format("{:.17g} {:.17g} ", p.friction_off.value, p.friction_on.value);
      },
      0);
  return std::accumulate(out.begin(), out.end(), std::string());
}

// Each truth by an evaluation of its own: nothing of how a lab moves members is in it.
void find_truths(World& w, const Belief& truths, const std::string& folder) {
  Unfinished kept(folder, "truths of lab_bench " PAPILLA_VERSION "\n" + belief_text(truths));
  const std::size_t count = truths.members.size();
  w.truth.assign(w.experiments.size(), std::vector<Friction>(count));
  w.truth_worth.assign(w.designs.size(), std::vector<double>(count, 1e9));
  for (std::size_t i = 0; i < w.experiments.size(); ++i) {
    const Experiment& e = w.experiments[i];
    Design design = under_conditions(w.designs[e.design].design, e.at);
    design.accuracy.seed = kTruthSeed;
    const std::string key = text_hash(write_toml(to_table(design)));
    if (!kept.find(key)) kept.keep(key, frictions_text(design, truths));
    std::istringstream known(*kept.find(key));
    for (Friction& f : w.truth[i]) known >> f.off >> f.on;
    if (!known) throw InputError(kept.file() + ": unreadable");
    fmt::print(stderr, "truths, {} of {}\n", i + 1, w.experiments.size());
    if (e.at.voltage != w.file.conditions.voltage.back()) continue;
    for (std::size_t t = 0; t < count; ++t)
      w.truth_worth[e.design][t] =
          std::min(w.truth_worth[e.design][t], w.truth[i][t].on / w.truth[i][t].off - 1);
  }
}

World make_world(const std::string& folder, int members, int truths) {
  World w;
  w.file.conditions.humidity = {0.15, 0.35, 0.55, 0.75};
  w.file.conditions.voltage = {100, 200};
  w.file.conditions.load = {0.2};
  w.file.worth = "worst(modulation)";
  for (const std::string& name : kDesigns) {
    Design d = read_design(find_design("m3_samples/" + name + ".toml"));
    d.environment = {w.file.conditions.humidity, {}};
    d.finger.load = w.file.conditions.load.front();
    d.drive.amplitude = w.file.conditions.voltage.back();
    w.designs.push_back({name, d, true});
    w.file.designs.push_back({name, name + ".toml", true});
  }
  for (std::size_t d = 0; d < w.designs.size(); ++d) {
    for (const double v : w.file.conditions.voltage) {
      for (const double rh : w.file.conditions.humidity)
        w.experiments.push_back({d, {0.2, rh, v, 0, FingerState::Clean}});
    }
  }
  const Finger& finger = w.designs.front().design.finger;
  const auto note = [](const std::string& text) { fmt::print(stderr, "{}\n", text); };
  w.model = std::make_unique<MemberModel>(drawn(finger, members, "lab members"), folder, 0, note);
  w.table = std::make_unique<ResponseTable>(w.designs, *w.model);
  w.table->lay(w.experiments);
  const MetricExpression metric = parse_own_metric(w.file.worth);
  for (const LabDesign& d : w.designs) w.worth.push_back(w.model->worth(d, metric));
  find_truths(w, drawn(finger, truths, "lab truths"), folder);
  return w;
}

// The readings of a truth: each as its instrument scatters.
class Bench {
 public:
  Bench(const World& world, std::size_t truth, std::uint64_t stream)
      : world_(world), truth_(truth), random_(77, "lab readings", stream) {
    const Instrument& i = world.file.instrument;
    finger_ = i.finger_to_finger * random_.normal();
    for (std::size_t d = 0; d < world.designs.size(); ++d)
      design_.push_back(i.model * random_.normal());
  }

  void next_day() { day_ = world_.file.instrument.day_to_day * random_.normal(); }
  // An error of the model: friction at some experiments times exp(size).
  void plant(std::function<bool(const Experiment&, bool on)> where, double size) {
    where_ = std::move(where);
    planted_ = size;
  }

  FrictionReading measure(const Experiment& e, int day) {
    FrictionReading r;
    r.experiment = e;
    r.finger = "1";
    r.day = fmt::format("{}", day);
    const Friction& is = world_.truth[world_.index(e)][truth_];
    const auto read = [&](double friction, bool on) {
      const double wrong = where_ && where_(e, on) ? planted_ : 0;
      return friction * std::exp(finger_ + day_ + design_[e.design] + wrong +
                                 world_.file.instrument.repeatability * random_.normal());
    };
    r.off = read(is.off, false);
    r.on = read(is.on, true);
    return r;
  }

 private:
  const World& world_;
  std::size_t truth_;
  RandomStream random_;
  double finger_ = 0, day_ = 0, planted_ = 0;
  std::vector<double> design_;
  std::function<bool(const Experiment&, bool)> where_;
};

std::unique_ptr<Standing> stand(const World& w, const std::vector<FrictionReading>& readings) {
  return standing_of(w.model->belief(), w.file, w.designs, *w.table, readings, w.worth, {});
}

// How far a lab's members, moved, are from evaluations of them: of the truths' own belief, on the
// designs' skins.
void judge_moves(const World& w, const Belief& truths, const std::string& folder) {
  MemberModel model(truths, folder, 0);
  double off = 0, ratio = 0, move = 0, n = 0;
  for (std::size_t i = 0; i < w.experiments.size(); ++i) {
    const Experiment& e = w.experiments[i];
    const MemberFriction f = model.friction(w.designs[e.design], e.at);
    for (std::size_t t = 0; t < truths.members.size(); ++t) {
      const Friction& is = w.truth[i][t];
      off += square(std::log(f.off.at[t] / is.off));
      ratio += square(std::log(f.on.at[t] / f.off.at[t] * is.off / is.on));
      move += square(std::log(is.on / is.off / (f.on.own / f.off.own)));
      ++n;
    }
  }
  fmt::print(
      "\nMembers moved, against an evaluation of each on other skins (rms of {:.0f}): friction "
      "{:.1f} "
      "%, ratio of on and off {:.1f} %; members move that ratio by {:.1f} %.\n",
      n, 100 * std::sqrt(off / n), 100 * std::sqrt(ratio / n), 100 * std::sqrt(move / n));
}

// How widely belief spreads the differences that decide: the root of the mean square of the 95 %
// intervals of a design's worth less that of the design chosen at first.
double width(const Standing& s, const Evidence& evidence, std::size_t first,
             const std::vector<double>& p_first) {
  const WorthAfter after = worth_after(s.ensemble, s.kernels, evidence);
  double sum = 0, weight = 0;
  for (std::size_t d = 0; d < after.worth.size(); ++d) {
    if (d == first) continue;
    std::vector<double> difference = after.worth[d];
    for (std::size_t k = 0; k < difference.size(); ++k) difference[k] -= after.worth[first][k];
    const double w = weighted_quantile(difference, after.weights, 0.975) -
                     weighted_quantile(difference, after.weights, 0.025);
    sum += p_first[d] * w * w;
    weight += p_first[d];
  }
  return std::sqrt(sum / weight);
}

enum class Plan { Decision, Hypotheses, DOptimal, Grid };

// Before any reading.
struct Start {
  std::unique_ptr<Standing> standing;
  std::vector<double> p_best;
  double width = 0;
};

Start start_of(const World& w) {
  Start out{stand(w, {}), {}, 0};
  for (const Prospect& p : out.standing->prospects) out.p_best.push_back(p.p_best);
  out.width = width(*out.standing, *out.standing->evidence, out.standing->best, out.p_best);
  return out;
}

// After some touches.
struct Mark {
  int touches = 0;
  double seconds = 0, p_right = 0;
  double loss = 0, expected_loss = 0;  // of the choice, shares: by the truth, by the lab itself
  bool right = false;
};

std::vector<Experiment> batch_of(const World& w, const Standing& s, Plan plan, int done, int day) {
  std::vector<Experiment> out;
  if (plan == Plan::Grid) {
    // Humidity by humidity, all designs at the highest voltage, then at the next one.
    std::vector<Experiment> sweep;
    for (const double v : {200.0, 100.0}) {
      for (const double rh : w.file.conditions.humidity) {
        for (const Experiment& e : w.experiments) {
          if (e.at.voltage == v && e.at.relative_humidity == rh) sweep.push_back(e);
        }
      }
    }
    for (int k = 0; k < kRound; ++k)
      out.push_back(sweep[static_cast<std::size_t>(done + k) % sweep.size()]);
    return out;
  }
  NextOptions options;
  options.aim = plan == Plan::Decision     ? Aim::Decision
                : plan == Plan::Hypotheses ? Aim::Hypotheses
                                           : Aim::Parameters;
  options.count = kRound;
  options.day = fmt::format("{}", day);
  options.date = "2026-01-01";
  const PlanRecord record = plan_batch(s, *w.table, w.experiments, w.file, options, 0);
  // Each once, in the order in which they gain, before any again; humidity by humidity where a
  // change of it takes time.
  std::vector<double> humidities;
  for (const PlannedExperiment& e : record.experiments) {
    const double humidity = w.file.costs.humidity > 0 ? e.experiment.at.relative_humidity : 0;
    if (std::find(humidities.begin(), humidities.end(), humidity) == humidities.end())
      humidities.push_back(humidity);
  }
  for (const double humidity : humidities) {
    for (int k = 0; k < kRound; ++k) {
      for (const PlannedExperiment& e : record.experiments) {
        if ((humidity == 0 || e.experiment.at.relative_humidity == humidity) && k < e.repeats)
          out.push_back(e.experiment);
      }
    }
  }
  return out;
}

double cost(const World& w, const std::vector<Experiment>& batch) {
  std::vector<Candidate> candidates;
  std::vector<std::size_t> all;
  for (const Experiment& e : batch) {
    all.push_back(candidates.size());
    candidates.push_back({e, {}});
  }
  return seconds_of(candidates, all, w.file.costs);
}

// When the width is half of the first, to a touch; infinite: not within kWanted.
struct Halved {
  double touches = INFINITY, seconds = INFINITY;
};

struct Course {
  std::vector<Mark> marks;  // after each day
  Halved halved;
};

Course run(const World& w, const Start& start, std::size_t truth, std::size_t scatter, Plan plan) {
  Bench bench(w, truth, truth * 10 + scatter);
  std::vector<FrictionReading> readings;
  Course out;
  auto s = stand(w, readings);
  double seconds = 0;
  const auto mark = [&] {
    double best = -1e9;
    for (const auto& of : w.truth_worth) best = std::max(best, of[truth]);
    const std::size_t right = truth % kHypotheses.size();
    const auto heaviest = std::max_element(s->p_hypothesis.begin(), s->p_hypothesis.end());
    out.marks.push_back({static_cast<int>(readings.size()), seconds, s->p_hypothesis[right],
                         (best - w.truth_worth[s->best][truth]) / best,
                         s->prospects[s->best].regret / s->best_worth,
                         static_cast<std::size_t>(heaviest - s->p_hypothesis.begin()) == right});
  };
  mark();
  for (int day = 1; static_cast<int>(readings.size()) < kMost; ++day) {
    bench.next_day();
    const std::vector<Experiment> batch =
        batch_of(w, *s, plan, static_cast<int>(readings.size()), day);
    if (batch.empty()) break;
    std::vector<Experiment> done;
    for (const Experiment& e : batch) {
      readings.push_back(bench.measure(e, day));
      done.push_back(e);
      if (!std::isinf(out.halved.touches) || readings.size() > kWanted) continue;
      const auto now = stand(w, readings);
      if (width(*now, *now->evidence, start.standing->best, start.p_best) <= start.width / 2)
        out.halved = {static_cast<double>(readings.size()), seconds + cost(w, done)};
    }
    seconds += cost(w, batch);
    s = stand(w, readings);
    mark();
  }
  return out;
}

double median(std::vector<double> v) {
  std::sort(v.begin(), v.end());
  return v.empty() ? NAN : v[v.size() / 2];
}

// The first touches after which the mean loss of all truths stays small; infinite: never. A plan
// that has stopped keeps its choice.
double touches_to_small_loss(const std::vector<std::vector<Mark>>& of_truths) {
  double out = INFINITY;
  for (int touches = kMost; touches >= 0; touches -= kRound) {
    double mean = 0;
    for (const std::vector<Mark>& marks : of_truths) {
      const auto at = std::find_if(marks.rbegin(), marks.rend(),
                                   [&](const Mark& m) { return m.touches <= touches; });
      mean += at->loss / static_cast<double>(of_truths.size());
    }
    if (mean >= kSmallLoss) break;
    out = touches;
  }
  return out;
}

struct NamedPlan {
  const char* name;
  Plan plan;
};

const NamedPlan kDecision{"`--for decision`", Plan::Decision},
    kHypothesesPlan{"`--for hypotheses`", Plan::Hypotheses},
    kDOptimal{"`--for parameters` (D-optimal)", Plan::DOptimal}, kGrid{"grid", Plan::Grid};

void judge_plans(const World& w, const Start& start, std::size_t truths,
                 const std::vector<NamedPlan>& plans) {
  fmt::print(
      "| plan | halved within 30 touches | median touches to half | median hours to half | "
      "heaviest "
      "hypothesis is right after 30 touches | mean loss of the choice: before, after 30 touches | "
      "after 30, as the lab expects | touches until it stays under 2 % "
      "|\n|---|---|---|---|---|---|---|---|\n");
  const std::size_t all = truths * kScatters;
  const auto count = static_cast<double>(all);
  for (const auto& [name, plan] : plans) {
    std::vector<double> touches, hours;
    std::vector<std::vector<Mark>> of_all;
    int within = 0, right = 0;
    double before = 0, after = 0, square_after = 0, expected = 0;
    for (std::size_t i = 0; i < all; ++i) {
      const Course course = run(w, start, i / kScatters, i % kScatters, plan);
      const std::vector<Mark>& marks = of_all.emplace_back(course.marks);
      const Halved& h = course.halved;
      touches.push_back(h.touches);
      hours.push_back(h.seconds / 3600);
      within += h.touches <= kWanted;
      std::size_t k = 0;
      while (k + 1 < marks.size() && marks[k].touches < kWanted) ++k;
      right += marks[k].right;
      before += marks.front().loss / count;
      after += marks[k].loss / count;
      square_after += square(marks[k].loss) / count;
      expected += marks[k].expected_loss / count;
      fmt::print(stderr,
                 "{} {}: half at {:.0f} touches {:.1f} h, p right {:.3f}, loss {:.3f} -> "
                 "{:.3f}\n",
                 name, i, h.touches, h.seconds / 3600, marks[k].p_right, marks.front().loss,
                 marks[k].loss);
    }
    const double small = touches_to_small_loss(of_all);
    const auto said = [](double value, int digits) {
      return std::isinf(value) ? fmt::format("over {}", kWanted)
                               : fmt::format("{:.{}f}", value, digits);
    };
    // Courses of one truth are alike: the error is that of as many as there are truths.
    fmt::print(
        "| {} | {} of {} | {} | {} | {} of {} | {:.1f} %, {:.1f} ± {:.1f} % | {:.1f} % | {} |\n",
        name, within, all, said(median(touches), 0), said(median(hours), 1), right, all,
        100 * before, 100 * after,
        100 * std::sqrt((square_after - square(after)) / static_cast<double>(truths)),
        100 * expected,
        std::isinf(small) ? fmt::format("not within {}", kMost) : fmt::format("{:.0f}", small));
  }
}

// The width that a truth's readings of some experiments leave, of the first. course: the truth and
// the scatter of its readings.
class Touched {
 public:
  Touched(const World& world, const Start& start) : world_(world), start_(start) {}

  double operator()(std::size_t course, const std::vector<std::size_t>& experiments) const {
    const Standing& s = *start_.standing;
    const Instrument& instrument = world_.file.instrument;
    const std::size_t truth = course / kScatters;
    Bench bench(world_, truth, truth * 10 + course % kScatters);
    bench.next_day();
    Evidence evidence(s.ensemble, s.kernels, instrument);
    for (const std::size_t e : experiments) {
      const FrictionReading r = bench.measure(world_.experiments[e], 1);
      const MeasurableCell& cell = world_.table->cell(r.experiment);
      for (const Observation& o :
           observations_of(*world_.table, r.experiment, instrument, 0, 0, r.finger, r.day))
        evidence.add(o, std::log(cell.on && o.row == *cell.on ? r.on : r.off));
    }
    return width(s, evidence, s.best, start_.p_best) / start_.width;
  }

 private:
  const World& world_;
  const Start& start_;
};

// What no plan can beat: all sets of so many touches, told to all truths with all their scatters;
// of them the one that halves most, and how many any of them halves, chosen for each when its
// readings are known. Sets of more than two grow from the best hundred of one less.
void judge_least(const World& w, const Start& start, std::size_t truths) {
  const std::size_t courses = truths * kScatters;
  constexpr int kTouches = 4;
  constexpr std::size_t kKept = 100;
  fmt::print(
      "\n| touches | sets tried | halved by the set that halves most | hours that it takes "
      "| "
      "halved by some set, chosen for each with its readings known "
      "|\n|---|---|---|---|---|\n");
  const Touched touched(w, start);
  std::vector<std::vector<std::size_t>> sets{{}};
  for (int touches = 1; touches <= kTouches; ++touches) {
    std::vector<std::vector<std::size_t>> wider;
    for (const std::vector<std::size_t>& set : sets) {
      for (std::size_t e = touches == 2 ? set.back() : 0; e < w.experiments.size(); ++e) {
        wider.push_back(set);
        wider.back().push_back(e);
      }
    }
    std::vector<std::vector<double>> widths(wider.size(), std::vector<double>(courses));
    parallel_for(
        static_cast<int>(wider.size()),
        [&](int i) {
          const auto k = static_cast<std::size_t>(i);
          for (std::size_t t = 0; t < courses; ++t) widths[k][t] = touched(t, wider[k]);
        },
        0);
    std::size_t most = 0, some = 0, at = 0;
    std::vector<double> least(courses, INFINITY);
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t k = 0; k < wider.size(); ++k) {
      std::size_t halved = 0;
      double sum = 0;
      for (std::size_t t = 0; t < courses; ++t) {
        halved += widths[k][t] <= 0.5;
        least[t] = std::min(least[t], widths[k][t]);
        sum += std::log(widths[k][t]);
      }
      if (halved > most) at = k;
      most = std::max(most, halved);
      order.push_back({sum, k});
    }
    for (const double width : least) some += width <= 0.5;
    std::vector<Experiment> best;
    for (const std::size_t e : wider[at]) best.push_back(w.experiments[e]);
    fmt::print("| {} | {} | {} of {} | {:.1f} | {} of {} |\n", touches, wider.size(), most, courses,
               cost(w, best) / 3600, some, courses);
    std::sort(order.begin(), order.end());
    sets.clear();
    const std::size_t kept = touches == 1 ? order.size() : std::min(kKept, order.size());
    for (std::size_t k = 0; k < kept; ++k) sets.push_back(wider[order[k].second]);
  }
}

// An error of 20 % somewhere, in 64 touches: two thirds of the designs each day at every humidity,
// at one voltage on a day and at the other on the next.
void judge_discrepancy(const World& w, std::size_t truths) {
  fmt::print(
      "\n| model error planted | found (members explain with less than 50 %) | at its place |\n"
      "|---|---|---|\n");
  struct Planted {
    const char* name;
    const char* where;
    std::function<bool(const Experiment&, bool)> is;
  };
  const std::vector<Planted> places{
      {"20 % at 75 % RH", "at 75 % RH",
       [](const Experiment& e, bool) { return e.at.relative_humidity == 0.75; }},
      {"20 % of one design", "of a4h600", [](const Experiment& e, bool) { return e.design == 4; }},
      {"20 % under voltage", "under voltage", [](const Experiment&, bool on) { return on; }},
      {"none", "", [](const Experiment&, bool) { return false; }}};
  for (const Planted& p : places) {
    int found = 0, located = 0;
    for (std::size_t t = 0; t < truths; ++t) {
      Bench bench(w, t, t * 10 + 5);
      bench.plant(p.is, std::log(1.2));
      std::vector<FrictionReading> readings;
      for (int day = 1; day <= 4; ++day) {
        bench.next_day();
        for (const Experiment& e : w.experiments) {
          if (e.at.voltage == w.file.conditions.voltage[static_cast<std::size_t>(day % 2)] &&
              (e.design + static_cast<std::size_t>(day)) % 3 != 0)
            readings.push_back(bench.measure(e, day));
        }
      }
      const auto s = stand(w, readings);
      const Discrepancies& d = s->discrepancies;
      found += d.none < 0.5;
      located += d.none < 0.5 && d.found.front().where == p.where;
      fmt::print(stderr, "{} truth {}: none {:.3f}, {} {:.2f} {:+.3f}\n", p.name, t, d.none,
                 d.found.front().where, d.found.front().probability, d.found.front().shift);
    }
    fmt::print("| {} | {} of {} | {} |\n", p.name, found, truths,
               p.where[0] ? fmt::format("{}", located) : "");
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2 && argc != 4) {
    fmt::print(stderr, "lab_bench FOLDER [MEMBERS TRUTHS]\n");
    return 2;
  }
  try {
    const int members = argc > 2 ? std::atoi(argv[2]) : 80,
              truths = argc > 3 ? std::atoi(argv[3]) : 20;
    World w = make_world(argv[1], members, truths);
    const Start start = start_of(w);
    const auto count = static_cast<std::size_t>(truths);
    judge_plans(w, start, count, {kDecision, kHypothesesPlan, kDOptimal, kGrid});
    judge_least(w, start, count);
    const Costs costs = w.file.costs;
    w.file.costs.humidity = w.file.costs.design = w.file.costs.state = 0;
    fmt::print("\nWhere set-ups take no time:\n\n");
    judge_plans(w, start, count, {kDecision, kDOptimal});
    w.file.costs = costs;
    judge_discrepancy(w, count);
    judge_moves(w, drawn(w.designs.front().design.finger, truths, "lab truths"), argv[1]);
  } catch (const InputError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  }
  return 0;
}
