#include "calibrate/calibrate.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "base/check.h"
#include "base/constants.h"
#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "base/units.h"
#include "config/describe.h"
#include "config/reader.h"
#include "design/design.h"
#include "forward/forward.h"
#include "forward/scale_bridge.h"

namespace papilla {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr double kLargestCoefficient = 10;  // friction over load that a table may say
constexpr const char* kWaterScale = "water.scale";
const std::vector<std::string> kColumns{
    "design",  "relative_humidity", "amplitude_V", "frequency_Hz", "load_N",
    "F_off_N", "F_off_sd_N",        "F_on_N",      "F_on_sd_N"};

// --- The user's table -------------------------------------------------------------------------

class FrictionReader {
 public:
  explicit FrictionReader(const std::string& path) : path_(path) {}

  std::vector<FrictionDatum> read() {
    std::istringstream text(read_bytes(path_, std::size_t{1} << 24));
    std::vector<FrictionDatum> out;
    std::string line;
    std::vector<std::size_t> column;  // of each of kColumns
    std::size_t columns = 0;
    while (std::getline(text, line)) {
      ++line_;
      if (!line.empty() && line.back() == '\r') line.pop_back();
      if (line_ == 1 && line.starts_with("\xEF\xBB\xBF")) line.erase(0, 3);
      if (line.find_first_not_of(" \t,") == std::string::npos || line[0] == '#') continue;
      const std::vector<std::string> cells = split(line, ',');
      if (column.empty()) {
        if (cells.size() == 1 && line.find_first_of(";\t") != std::string::npos) {
          problem("", "the separator is a comma, decimals a point");
          break;
        }
        columns = cells.size();
        if (!header(cells, column)) break;
        continue;
      }
      if (cells.size() != columns) {
        problem("", fmt::format("expected {} cells, got {}", columns, cells.size()));
        continue;
      }
      row(cells, column, out);
    }
    if (column.empty() && problems_.empty()) problem("", "no header line");
    if (out.empty() && problems_.empty()) problem("", "no rows below the header");
    if (!problems_.empty()) throw InputError(problems_);
    return out;
  }

 private:
  void problem(const std::string& key, const std::string& message, int cell = 0) {
    problems_.push_back({path_, line_, cell, key, message});
  }

  bool header(const std::vector<std::string>& cells, std::vector<std::size_t>& column) {
    bool good = true;
    for (const std::string& name : kColumns) {
      const auto found = std::find(cells.begin(), cells.end(), name);
      column.push_back(static_cast<std::size_t>(found - cells.begin()));
      if (found != cells.end()) continue;
      std::vector<std::string> unknown;  // a column that has its own name is not this one misspelt
      for (const std::string& cell : cells) {
        if (std::find(kColumns.begin(), kColumns.end(), cell) == kColumns.end())
          unknown.push_back(cell);
      }
      const std::string near = nearest_name(name, unknown);
      problem(name, near.empty() ? "no such column; expected " + join_names(kColumns)
                                 : fmt::format("no such column, is it `{}`?", near));
      good = false;
    }
    for (const std::string& cell : cells) {
      if (std::find(kColumns.begin(), kColumns.end(), cell) != kColumns.end()) continue;
      problem(cell, "unknown column; expected " + join_names(kColumns));
      good = false;
    }
    return good;
  }

  void row(const std::vector<std::string>& cells, const std::vector<std::size_t>& column,
           std::vector<FrictionDatum>& out) {
    const std::size_t before = problems_.size();
    FrictionDatum d;
    d.line = line_;
    const auto cell = [&](std::size_t i) -> const std::string& { return cells[column[i]]; };
    const auto number = [&](std::size_t i, double low, double high, bool may_be_empty) {
      const std::string& text = cell(i);
      if (text.empty() && may_be_empty) return 0.0;
      double value = 0;
      if (const auto q = parse_quantity(text); i == 1 && q && q->unit == "%") {
        value = q->si;
      } else {
        try {
          std::size_t used = 0;
          value = std::stod(text, &used);
          if (used != text.size()) throw std::invalid_argument("");
        } catch (const std::exception&) {
          problem(kColumns[i], fmt::format("expected a number, got \"{}\"", text),
                  static_cast<int>(column[i]) + 1);
          return 0.0;
        }
      }
      if (!(value >= low && value <= high)) {
        problem(kColumns[i], fmt::format("{} lies outside {} to {}", text, low, high),
                static_cast<int>(column[i]) + 1);
      }
      return value;
    };
    const fs::path beside = fs::path(path_).parent_path() / cell(0);
    d.design = beside.string();
    std::error_code error;
    if (cell(0).empty() || !fs::is_regular_file(beside, error)) {
      d.design = find_beside(cell(0), path_, design_roots());
      if (cell(0).empty() || d.design.empty())
        problem("design", fmt::format("no file \"{}\" beside the table", cell(0)),
                static_cast<int>(column[0]) + 1);
    }
    d.relative_humidity = number(1, 0, 1, false);
    d.amplitude = number(2, 0, 1e5, true);
    d.frequency = number(3, 0, 1e9, d.amplitude == 0);
    d.load = number(4, 1e-6, 100, false);
    d.off = number(5, 0, 1e3, false);
    d.off_sd = number(6, 1e-9, 1e3, false);
    const bool on = !cell(7).empty();
    if (on) {
      d.on = number(7, 0, 1e3, false);
      d.on_sd = number(8, 1e-9, 1e3, false);
      if (d.amplitude == 0)
        problem("F_on_N", "a friction under voltage, but amplitude_V is 0",
                static_cast<int>(column[7]) + 1);
    }
    // No skin rubs at ten times its load (coefficients are 0.1 to 3): it is another unit.
    const bool readable = problems_.size() == before;
    for (const int i : {5, 7}) {
      const double force = i == 5 ? d.off : d.on;
      if (!readable || force <= kLargestCoefficient * d.load) continue;
      problem(kColumns[static_cast<std::size_t>(i)],
              fmt::format("{:.6g} N is {:.3g} times the load of {:.3g} N{}", force, force / d.load,
                          d.load,
                          force > 50 * d.load
                              ? fmt::format("; are these mN? Then {:.4g} N is meant", force / 1000)
                              : "; no finger rubs so"),
              static_cast<int>(column[static_cast<std::size_t>(i)]) + 1);
    }
    if (problems_.size() == before) out.push_back(d);
  }

  std::string path_;
  int line_ = 0;
  std::vector<Problem> problems_;
};

// Fits with the correction to the fine level taken anew, and the change of a friction below which
// it is good enough, in standard deviations of the datum.
constexpr int kMostRounds = 3;
constexpr double kSmallCorrection = 0.25;

// --- Residuals --------------------------------------------------------------------------------

// Rows of one design, drive and load: one evaluation over their humidities.
struct MeasuredGroup {
  Design design;
  std::vector<std::size_t> rows;         // into the data
  std::vector<std::size_t> humidity_of;  // of each row, into the environment's list
};

class Comparison {
 public:
  Comparison(const Calibration& calibration, int threads)
      : calibration_(calibration), threads_(threads), factors_(calibration.data.size()) {
    const std::set<std::string> wanted(calibration.fit.begin(), calibration.fit.end());
    for (ClaimTarget& target : m3_targets()) {
      if (wanted.count(target.claim)) targets_.push_back(std::move(target));
    }
    group();
    for (const ClaimTarget& t : targets_)
      rows_.push_back({t.claim, t.what, t.low, t.high, t.sd, 0, 0, 0});
    for (const FrictionDatum& d : calibration.data) {
      const auto add = [&](const char* name, double value, double sd) {
        rows_.push_back({fmt::format("line {}", d.line),
                         fmt::format("{} of {} at {:.0f} % RH, {} V, mN", name,
                                     fs::path(d.design).stem().string(), 100 * d.relative_humidity,
                                     d.amplitude),
                         value * 1e3, value * 1e3, sd * 1e3, 0, 0, 0});
      };
      add("F_off", d.off, d.off_sd);
      if (d.on_sd > 0) add("F_on", d.on, d.on_sd);
    }
  }

  std::vector<FitRow>& rows() { return rows_; }
  int size() const { return static_cast<int>(rows_.size()); }

  // The model at every row, with the error of its sampling.
  std::vector<Estimate> model(const Finger& finger) const {
    std::vector<Estimate> out;
    ClaimInputs inputs(finger, finger.calibrated_for.preset, threads_, calibration_.sampling);
    for (const ClaimTarget& t : targets_) out.push_back(t.model(inputs));
    const std::vector<Friction> friction = frictions(finger, calibration_.sampling);
    for (std::size_t i = 0; i < friction.size(); ++i) {
      const auto add = [&](const Estimate& force, double factor) {
        out.push_back({1e3 * factor * force.value, 1e3 * factor * force.se});
      };
      add(friction[i].off, factors_[i].off);
      if (calibration_.data[i].on_sd > 0) add(friction[i].on, factors_[i].on);
    }
    return out;
  }

  // What a coarse level gets wrong in a friction, a factor: taken at this finger from the level of
  // the checks on the same skins. Returns the largest change of a friction in standard deviations
  // of its datum. Eq. calibration.6
  double correct(const Finger& finger) {
    ClaimSampling fine = calibration_.sampling;
    fine.level = calibration_.check.level;
    fine.grid = calibration_.check.grid;
    const ClaimSampling& coarse = calibration_.sampling;
    if (calibration_.data.empty() || (fine.level == coarse.level && fine.grid == coarse.grid))
      return 0;
    const std::vector<Friction> good = frictions(finger, fine), fast = frictions(finger, coarse);
    double largest = 0;
    for (std::size_t i = 0; i < good.size(); ++i) {
      const FrictionDatum& d = calibration_.data[i];
      const auto update = [&](double& factor, const Estimate& from, const Estimate& to, double sd) {
        if (!(from.value > 0) || !(to.value > 0)) return;
        const double now = to.value / from.value;
        largest = std::max(largest, std::abs(now - factor) * from.value / sd);
        factor = now;
      };
      update(factors_[i].off, fast[i].off, good[i].off, d.off_sd);
      if (d.on_sd > 0) update(factors_[i].on, fast[i].on, good[i].on, d.on_sd);
    }
    return largest;
  }

  // Distance from the band in standard deviations: the data's and the model's sampling error,
  // which stays what it was at the start. Eq. calibration.5
  bool residuals(const Finger& finger, std::span<double> r) const {
    const std::vector<Estimate> values = model(finger);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const FitRow& row = rows_[i];
      if (!std::isfinite(values[i].value)) return false;
      const double miss = values[i].value - std::clamp(values[i].value, row.low, row.high);
      r[i] = miss / std::hypot(row.sd, row.sampling_sd);
    }
    return true;
  }

 private:
  struct Friction {
    Estimate off, on;  // [N], with the error of the skins
  };
  struct Factor {
    double off = 1, on = 1;
  };

  // Of the data's rows.
  std::vector<Friction> frictions(const Finger& finger, const ClaimSampling& sampling) const {
    std::vector<Friction> out(calibration_.data.size());
    const Fidelity fidelity = sampling.fidelity(threads_);
    for (const MeasuredGroup& s : groups_) {
      Scene scene = scene_of(s.design);
      const double load = scene.finger.load;
      const FingerState state = scene.finger.state;
      scene.finger = finger;
      scene.finger.load = load;
      scene.finger.state = state;
      scene.model = finger.calibrated_for;
      const Response response = evaluate(scene, s.design.texture, fidelity);
      for (std::size_t k = 0; k < s.rows.size(); ++k) {
        const ResponsePoint& p = response.points[s.humidity_of[k]];
        out[s.rows[k]] = {{p.friction_off.value, p.friction_off.parts.sampling},
                          {p.friction_on.value, p.friction_on.parts.sampling}};
      }
    }
    return out;
  }

  void group() {
    std::map<std::tuple<std::string, double, double, double>, std::vector<std::size_t>> same;
    for (std::size_t i = 0; i < calibration_.data.size(); ++i) {
      const FrictionDatum& d = calibration_.data[i];
      same[{d.design, d.amplitude, d.frequency, d.load}].push_back(i);
    }
    for (const auto& [key, rows] : same) {
      const FrictionDatum& d = calibration_.data[rows.front()];
      MeasuredGroup s{read_design(d.design), rows, {}};
      s.design.drive.amplitude = d.amplitude;
      if (d.frequency > 0) s.design.drive.frequency = d.frequency;
      s.design.finger.load = d.load;
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

  const Calibration& calibration_;
  int threads_;
  std::vector<ClaimTarget> targets_;
  std::vector<MeasuredGroup> groups_;
  std::vector<Factor> factors_;  // of each datum
  std::vector<FitRow> rows_;
};

// --- The file ---------------------------------------------------------------------------------

class CalibrationReader {
 public:
  CalibrationReader(Document& document, const std::string& path)
      : document_(document), path_(path) {}

  Calibration read() {
    document_.take("schema_version");
    out_.file = path_;
    text("title", out_.title);
    read_finger_file();
    numbers_ = number_fields(out_.finger);
    read_lists();
    read_data();
    read_sampling("sampling", out_.sampling);
    read_sampling("check", out_.check);
    integer("iterations", 1, 1000, out_.iterations);
    if (const Node* node = document_.take("profiles")) {
      if (node->kind == Node::Kind::Flag) {
        out_.profiles = node->flag;
      } else {
        document_.problem(node->place, "profiles", "expected true or false");
      }
    }
    read_parameters();
    if (out_.fit.empty() && out_.data.empty() && document_.problems().empty())
      document_.problem_at("fit", "nothing to fit to: name claims in `fit` or a table in `data`");
    finish(document_);
    return out_;
  }

 private:
  bool text(const char* key, std::string& value) {
    const Node* node = document_.take(key);
    if (!node) return false;
    if (!node->is_text()) {
      document_.problem(node->place, key, "expected a text, got " + describe(*node));
      return false;
    }
    value = node->text;
    return true;
  }

  void integer(const std::string& key, int low, int high, int& value) {
    const Node* node = document_.take(key);
    if (!node) return;
    if (node->kind != Node::Kind::Integer || node->integer < low || node->integer > high) {
      document_.problem(node->place, key,
                        fmt::format("expected a whole number from {} to {}", low, high));
      return;
    }
    value = static_cast<int>(node->integer);
  }

  std::string beside(const std::string& key) {
    std::string name;
    if (!text(key.c_str(), name)) return "";
    const std::string found = find_beside(name, path_, design_roots());
    if (found.empty()) document_.problem_at(key, fmt::format("no file \"{}\"", name));
    return found;
  }

  void from_file(const std::string& key, const std::function<void(const std::string&)>& read) {
    const std::string file = beside(key);
    if (file.empty()) return;
    try {
      read(file);
    } catch (const InputError& error) {
      for (const Problem& p : error.problems())
        document_.problem({p.file, p.line, p.column}, p.key, p.message);
    }
  }

  void read_finger_file() {
    if (!document_.has("finger")) {
      document_.problem_at("finger", "missing `finger`: the file where the fit starts");
      return;
    }
    from_file("finger", [&](const std::string& file) { out_.finger = read_finger(file); });
  }

  void read_data() {
    from_file("data", [&](const std::string& file) { out_.data = read_friction(file); });
  }

  void read_lists() {
    std::set<std::string> known, with_numbers;
    for (const Claim& claim : m3_claims()) known.insert(claim.id);
    for (const ClaimTarget& t : m3_targets()) with_numbers.insert(t.claim);
    for (const auto& [key, list] : {std::pair{"fit", &out_.fit}, {"hold_out", &out_.hold_out}}) {
      const Node* node = document_.take(key);
      if (!node) continue;
      if (!node->is_array()) {
        document_.problem(node->place, key, "expected a list of claims, got " + describe(*node));
        continue;
      }
      const bool fitted = list == &out_.fit;
      const std::set<std::string>& allowed = fitted ? with_numbers : known;
      for (const Node& item : node->children) {
        if (!item.is_text() || !allowed.count(item.text)) {
          document_.problem(item.place, key,
                            fmt::format("{} is no claim that can be {}; use {}", describe(item),
                                        fitted ? "fitted" : "held out",
                                        join_names({allowed.begin(), allowed.end()})));
          continue;
        }
        if (!fitted && std::find(out_.fit.begin(), out_.fit.end(), item.text) != out_.fit.end()) {
          document_.problem(item.place, key, item.text + " is among the fitted claims");
          continue;
        }
        list->push_back(item.text);
      }
    }
  }

  void read_sampling(const std::string& section, ClaimSampling& sampling) {
    const Node* node = document_.take(section);
    if (!node) return;
    if (!node->is_table()) {
      document_.problem(node->place, section, "expected a section, got " + describe(*node));
      return;
    }
    for (const Node& child : node->children) {
      if (child.key != "level" && child.key != "skins" && child.key != "first_skin" &&
          child.key != "grid")
        document_.problem(
            child.key_place, section,
            fmt::format("unknown key `{}`; use level, skins, first_skin, grid", child.key));
    }
    integer(section + ".skins", 4, 10000, sampling.skins);
    integer(section + ".first_skin", 0, 1 << 30, sampling.first_skin);
    integer(section + ".grid", 32, 2048, sampling.grid);
    std::string level = sampling.level;
    if (text((section + ".level").c_str(), level)) {
      const auto& names = accuracy_level_names();
      if (std::find(names.begin(), names.end(), level) == names.end())
        document_.problem_at(section + ".level", "expected one of " + join_names(names));
      sampling.level = level;
    }
  }

  void read_parameters() {
    const Node* section = document_.take("parameters");
    if (!section || !section->is_table() || section->children.empty()) {
      document_.problem_at("parameters", "expected a section [parameters] with what is fitted");
      return;
    }
    std::vector<std::string> names{kWaterScale};
    for (const NumberField& f : numbers_) names.push_back(f.path);
    std::vector<std::pair<std::string, const Node*>> members;
    collect(*section, "", members);
    for (const auto& [name, node] : members) {
      NumberField field{kWaterScale, "", 1e-6, 1e6, "", nullptr};
      if (name != kWaterScale) {
        const auto found =
            std::find_if(numbers_.begin(), numbers_.end(),
                         [&, path = name](const NumberField& f) { return f.path == path; });
        if (found == numbers_.end()) {
          const std::string near = nearest_name(name, names);
          document_.problem(
              node->key_place, "parameters",
              near.empty()
                  ? fmt::format("`{}` is no number of the finger", name)
                  : fmt::format("`{}` is no number of the finger, did you mean `{}`?", name, near));
          continue;
        }
        field = *found;
      }
      parameter(name, *node, field);
    }
  }

  // A parameter is a table with `low`; everything above it is a dotted path.
  static void collect(const Node& table, const std::string& path,
                      std::vector<std::pair<std::string, const Node*>>& out) {
    for (const Node& child : table.children) {
      const std::string full = path.empty() ? child.key : path + "." + child.key;
      if (!child.is_table() || child.find("low") || child.find("high") ||
          std::none_of(child.children.begin(), child.children.end(),
                       [](const Node& n) { return n.is_table(); })) {
        out.emplace_back(full, &child);
      } else {
        collect(child, full, out);
      }
    }
  }

  void parameter(const std::string& name, const Node& node, const NumberField& field) {
    const std::string where = "parameters." + name;
    CalibrationParameter p{name, field.unit, {}};
    p.fit.name = name;
    p.fit.start = field.value ? *field.value : 1;
    p.fit.step = 0.04;
    if (!node.is_table()) {
      document_.problem(
          node.place, where,
          "expected { low = ..., high = ..., prior = ..., factor = ... or sd = ... }");
      return;
    }
    bool low = false, high = false, prior = false, spread = false;
    const std::size_t before = document_.problems().size();
    for (const Node& child : node.children) {
      const NumberSpec spec{child.key.c_str(), field.unit, field.low, field.high, ""};
      double value = 0;
      if (child.key == "low" || child.key == "high" || child.key == "prior" ||
          child.key == "start") {
        if (!document_.number(child, where + "." + child.key, spec, value)) continue;
        if (child.key == "low") {
          p.fit.low = value;
          low = true;
        } else if (child.key == "high") {
          p.fit.high = value;
          high = true;
        } else if (child.key == "start") {
          p.fit.start = value;
        } else {
          p.fit.prior = value;
          prior = true;
        }
      } else if (child.key == "factor") {
        if (!document_.number(child, where + ".factor", {"factor", "", 1.0001, 1e6, ""}, value))
          continue;
        p.fit.prior_sd = std::log(value);
        p.fit.logarithmic = spread = true;
      } else if (child.key == "sd") {
        if (!document_.number(child, where + ".sd", {"sd", field.unit, 0, field.high, ""}, value))
          continue;
        p.fit.prior_sd = value;
        spread = true;
      } else {
        document_.problem(child.key_place, where,
                          fmt::format("unknown key `{}`; use low, high, start, prior, and factor "
                                      "or sd",
                                      child.key));
      }
    }
    if (document_.problems().size() > before) return;
    if (!low || !high) {
      document_.problem(node.place, where, "a parameter needs `low` and `high`");
    } else if (p.fit.low >= p.fit.high) {
      document_.problem(node.place, where, "expected low < high");
    } else if (prior != spread) {
      document_.problem(node.place, where, "a prior needs its width: `factor` or `sd`");
    } else if (p.fit.logarithmic && p.fit.low <= 0) {
      document_.problem(node.place, where, "a prior by a factor needs low above 0");
    } else if (p.fit.start < p.fit.low || p.fit.start > p.fit.high) {
      document_.problem(node.place, where,
                        fmt::format("the finger's {} lies outside the bounds",
                                    format_quantity(p.fit.start, field.unit)));
    } else {
      out_.parameters.push_back(std::move(p));
    }
  }

  Document& document_;
  std::string path_;
  Calibration out_;
  std::vector<NumberField> numbers_;
};

// --- The report -------------------------------------------------------------------------------

std::string shown(const CalibrationParameter& p, double si) {
  const auto unit = find_unit(p.unit);
  const double value = si / (unit ? unit->to_si : 1);
  return fmt::format("{:.4g}{}{}", value, p.unit.empty() ? "" : " ", p.unit);
}

std::string band(const FitRow& row) {
  if (row.low == row.high) return fmt::format("{:.4g}", row.low);
  if (!std::isfinite(row.high)) return fmt::format("above {:.3g}", row.low);
  if (!std::isfinite(row.low)) return fmt::format("below {:.3g}", row.high);
  return fmt::format("{:.3g} to {:.3g}", row.low, row.high);
}

// A chi squared a degree of freedom beyond which the fit says nothing about the finger: misses of
// four standard deviations each.
constexpr double kPoorFit = 16;

double misfit(const CalibrationResult& r) {
  return r.fit.chi2 / std::max(1, r.fit.degrees_of_freedom);
}

std::string misfit_text(const CalibrationResult& r) {
  std::size_t worst = 0;
  for (std::size_t i = 0; i < r.rows.size(); ++i) {
    if (std::abs(r.fit.residuals[i]) > std::abs(r.fit.residuals[worst])) worst = i;
  }
  return fmt::format(
      "the fitted finger does not explain the data: χ² a degree of freedom is {:.3g}, where 1 is "
      "expected; the worst is {} ({}), {:+.1f} standard deviations. Check units and the stated "
      "standard deviations, or let more parameters move; do not use this finger",
      misfit(r), r.rows[worst].source, r.rows[worst].what, r.fit.residuals[worst]);
}

Json number(double v) { return std::isfinite(v) ? Json(v) : Json(nullptr); }

bool holds(const ClaimResult& r) {
  return r.papilla.verdict == Verdict::Agrees || r.papilla.verdict == Verdict::Fitted;
}

bool is_fitted(const Calibration& c, const std::string& id) {
  return std::find(c.fit.begin(), c.fit.end(), id) != c.fit.end();
}

std::string direction_text(const Calibration& c, const FitDirection& d) {
  std::string out;
  for (std::size_t i = 0; i < d.weights.size(); ++i) {
    if (std::abs(d.weights[i]) < 0.2) continue;
    out += fmt::format("{}{:+.2f} {}", out.empty() ? "" : " ", d.weights[i], c.parameters[i].path);
  }
  return out;
}

}  // namespace

std::string calibration_warning(const CalibrationResult& result) {
  return misfit(result) > kPoorFit ? misfit_text(result) : "";
}

std::vector<FrictionDatum> read_friction(const std::string& path) {
  return FrictionReader(path).read();
}

Calibration read_calibration(const std::string& path) {
  Document document = load_document(path, {}, design_roots());
  return CalibrationReader(document, path).read();
}

Finger with_parameters(const Calibration& calibration, std::span<const double> values) {
  Finger finger = calibration.finger;
  const std::vector<NumberField> numbers = number_fields(finger);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::string& path = calibration.parameters[i].path;
    if (path == kWaterScale) {
      for (double& v : finger.water.volume) v *= values[i];
    } else {
      *find_number_field(numbers, path).value = values[i];
    }
  }
  return finger;
}

CalibrationResult calibrate(const Calibration& calibration, const CalibrationOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  const auto note = [&](const std::string& text) {
    if (options.note) options.note(text);
  };
  Comparison comparison(calibration, options.threads);
  std::vector<FitParameter> parameters;
  for (const CalibrationParameter& p : calibration.parameters) parameters.push_back(p.fit);
  const auto start = [&] {
    std::vector<double> v;
    for (const FitParameter& p : parameters) v.push_back(p.start);
    return with_parameters(calibration, v);
  }();

  CalibrationResult out;
  std::vector<FitRow>& rows = comparison.rows();
  comparison.correct(start);
  const std::vector<Estimate> before = comparison.model(start);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].before = before[i].value;
    rows[i].sampling_sd = before[i].se;
  }
  std::vector<double> r(rows.size());
  comparison.residuals(start, r);
  for (double v : r) out.chi2_before += v * v;
  note(fmt::format("{} residuals, {} parameters, chi2 {:.4g} at the start", rows.size(),
                   parameters.size(), out.chi2_before));

  LeastSquaresOptions fit;
  fit.iterations = calibration.iterations;
  fit.noise = 1e-6;  // of the contact solves; each parameter has its own step all the same
  fit.tolerance = 1e-4;
  fit.profiles = calibration.profiles;
  fit.profile_iterations = 4;
  fit.note = options.note;
  int evaluations = 0;
  const auto misses = [&](std::span<const double> p, std::span<double> out_of) {
    const bool ok = comparison.residuals(with_parameters(calibration, p), out_of);
    if (++evaluations % 10 == 0) {
      double sum = 0;
      for (double v : out_of) sum += v * v;
      note(fmt::format("evaluation {}: chi2 {:.4g}", evaluations, sum));
    }
    return ok;
  };
  // Where the fitted finger is far from the start the correction is another: again from there.
  for (int round = 0; round < kMostRounds; ++round) {
    out.fit = least_squares(parameters, comparison.size(), misses, fit);
    const std::vector<double> found = out.fit.values();
    if (comparison.correct(with_parameters(calibration, found)) < kSmallCorrection) break;
    note("frictions of the fine level have moved: fitted again from here");
    for (std::size_t i = 0; i < found.size(); ++i) parameters[i].start = found[i];
  }
  out.finger = with_parameters(calibration, out.fit.values());
  out.finger.fitted_to.clear();
  for (const std::string& id : calibration.fit)
    out.finger.fitted_to += (out.finger.fitted_to.empty() ? "" : " ") + id;
  // What Eq. accuracy.11 carries on: relative deviations; a number at its bound has none.
  out.finger.uncertainty.clear();
  std::vector<std::size_t> known;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const ParameterFit& f = out.fit.parameters[i];
    if (f.at_bound || !(f.se > 0) || !std::isfinite(f.se)) continue;
    ParameterDeviation row{f.name, f.se / std::abs(f.value), {}};
    for (const std::size_t j : known)
      row.correlation.push_back(out.fit.correlation[i * parameters.size() + j]);
    known.push_back(i);
    out.finger.uncertainty.push_back(std::move(row));
  }
  const std::vector<Estimate> after = comparison.model(out.finger);
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i].after = after[i].value;
  out.rows = rows;
  out.evaluations = evaluations + 2;

  const auto gap = [](const Finger& f) { return capacitive_gap(f, 1 / 30e-6, 0.256e-6, 0.45); };
  out.gap_before = gap(start);
  out.gap_after = gap(out.finger);
  if (options.check) {
    ReproduceOptions check;
    for (const auto* list : {&calibration.fit, &calibration.hold_out}) {
      for (const std::string& id : *list) {
        if (id != "C_gap") check.ids.push_back(id);
      }
    }
    if (!check.ids.empty()) {
      note("claims on other skins");
      check.threads = options.threads;
      check.sampling = calibration.check;
      check.one_preset = true;
      check.finger = start;
      check.finger.fitted_to = out.finger.fitted_to;
      out.claims_before = reproduce(check);
      check.finger = out.finger;
      out.claims_after = reproduce(check);
    }
    Design flat = read_design(find_design("m3_samples/flat.toml"));
    const double load = flat.finger.load;
    flat.finger = out.finger;
    flat.finger.load = load;
    flat.model = out.finger.calibrated_for;
    const Fidelity fidelity = calibration.check.fidelity(options.threads);
    for (const ResponsePoint& p : evaluate(scene_of(flat), flat.texture, fidelity).points)
      out.friction_coefficient.push_back(p.friction_off.value / load);
  }
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return out;
}

std::string calibration_markdown(const Calibration& c, const CalibrationResult& r) {
  std::string out = fmt::format("# Fit: {}\n\n", c.title.empty() ? c.finger.name : c.title);
  if (const std::string warning = calibration_warning(r); !warning.empty())
    out += "Warning: " + warning + ".\n\n";
  out += fmt::format(
      "{} residuals, {} parameters; χ² of the data {:.3g} before, {:.3g} after, of the priors "
      "{:.3g}; {} "
      "degrees of freedom; errors times {:.3g}; {} of the model; {}.\n",
      r.rows.size(), c.parameters.size(), r.chi2_before, r.fit.chi2, r.fit.prior_chi2,
      r.fit.degrees_of_freedom, std::sqrt(r.fit.variance_factor),
      counted(r.evaluations, "evaluation"),
      r.fit.converged ? "converged" : "stopped: " + r.fit.message);
  out += fmt::format(
      "Skins {} to {} at level {}{}.\n", c.sampling.first_skin,
      c.sampling.first_skin + c.sampling.skins - 1, c.sampling.level,
      c.data.empty() || c.check.level == c.sampling.level
          ? ""
          : fmt::format("; frictions corrected to level {} on the same skins", c.check.level));

  out +=
      "\n## Parameters\n\n| parameter | start | fitted | 95 % interval | prior | from the data, % "
      "|\n"
      "|---|---|---|---|---|---|\n";
  for (std::size_t i = 0; i < c.parameters.size(); ++i) {
    const CalibrationParameter& p = c.parameters[i];
    const ParameterFit& f = r.fit.parameters[i];
    const std::string prior =
        p.fit.prior_sd == 0 ? "none"
        : p.fit.logarithmic
            ? fmt::format("{} times or by {:.3g}", shown(p, p.fit.prior), std::exp(p.fit.prior_sd))
            : fmt::format("{} ± {}", shown(p, p.fit.prior), shown(p, p.fit.prior_sd));
    out += fmt::format("| {} | {} | {} | {}{} to {}{} | {} | {:.0f}{} |\n", p.path,
                       shown(p, p.fit.start), shown(p, f.value), shown(p, f.low),
                       f.low_open ? " (bound)" : "", shown(p, f.high),
                       f.high_open ? " (bound)" : "", prior, 100 * f.data_share,
                       f.at_bound ? "; at its bound, interval by profile" : "");
  }

  out += "\n## Correlations\n\n|  |";
  for (const CalibrationParameter& p : c.parameters) out += " " + p.path + " |";
  out += "\n|---|";
  for (std::size_t i = 0; i < c.parameters.size(); ++i) out += "---|";
  out += "\n";
  const std::size_t n = c.parameters.size();
  for (std::size_t i = 0; i < n; ++i) {
    out += "| " + c.parameters[i].path + " |";
    for (std::size_t k = 0; k < n; ++k)
      out += fmt::format(" {:.2f} |", r.fit.correlation[i * n + k]);
    out += "\n";
  }

  out +=
      "\n## What the data tell apart\n\nSingular directions of the data, in prior widths; below 1 "
      "the "
      "prior decides.\n\n| standard deviations a prior width | direction | |\n|---|---|---|\n";
  for (const FitDirection& d : r.fit.directions) {
    out += fmt::format("| {:.3g} | {} | {} |\n", d.singular_value, direction_text(c, d),
                       d.singular_value < 1 ? "not identified" : "");
  }

  out +=
      "\n## Residuals\n\n| source | quantity | data | sd | sampling of the model | before | after "
      "| "
      "miss, sd |\n|---|---|---|---|---|---|---|---|\n";
  for (std::size_t i = 0; i < r.rows.size(); ++i) {
    const FitRow& row = r.rows[i];
    out += fmt::format("| {} | {} | {} | {:.3g} | {:.2g} | {:.4g} | {:.4g} | {:+.2f} |\n",
                       row.source, row.what, band(row), row.sd, row.sampling_sd, row.before,
                       row.after, r.fit.residuals[i]);
  }

  for (const bool fitted : {true, false}) {
    std::string table;
    int before = 0, after = 0, count = 0;
    for (std::size_t i = 0; i < r.claims_after.size(); ++i) {
      const ClaimResult &a = r.claims_before[i], &b = r.claims_after[i];
      if (is_fitted(c, b.claim->id) != fitted) continue;
      ++count;
      before += holds(a);
      after += holds(b);
      table += fmt::format("| {} | {} | {}: {} | {}: {} |\n", b.claim->id, b.claim->statement,
                           holds(a) ? "holds" : "differs", a.papilla.model,
                           holds(b) ? "holds" : "differs", b.papilla.model);
    }
    if (count == 0) continue;
    out += fmt::format(
        "\n## {} claims\n\nOn {} other skins at level {}: {} of {} hold before, {} after.\n\n| id "
        "| "
        "claim | before | after |\n|---|---|---|---|\n",
        fitted ? "Fitted" : "Held-out", c.check.skins, c.check.level, before, count, after);
    out += table;
  }

  out += fmt::format(
      "\n## Beside other measurements\n\nGap by capacitance under the ridges at 1 N on 30 mm² "
      "(published 1.06 µm): {:.2f} µm before, {:.2f} µm after (docs/theory/coupling.md).\n",
      1e6 * r.gap_before, 1e6 * r.gap_after);
  if (r.friction_coefficient.size() == 4) {
    out += fmt::format(
        "Friction coefficient on flat glass at 0.2 N: {:.2f}, {:.2f}, {:.2f}, {:.2f} at 15, 35, "
        "55, "
        "75 % RH (published on screens at 1 N: 0.2 and 0.4; by mean field with 8 MPa 0.27 to "
        "0.33).\n",
        r.friction_coefficient[0], r.friction_coefficient[1], r.friction_coefficient[2],
        r.friction_coefficient[3]);
  }
  return out;
}

std::string calibration_json(const Calibration& c, const CalibrationResult& r) {
  Json parameters = Json::array(), rows = Json::array(), directions = Json::array(),
       claims = Json::array();
  for (std::size_t i = 0; i < c.parameters.size(); ++i) {
    const ParameterFit& f = r.fit.parameters[i];
    const FitParameter& given = c.parameters[i].fit;
    const auto unit = find_unit(c.parameters[i].unit);
    Json prior;
    if (given.prior_sd > 0) {
      prior = {{"value", given.prior}};
      prior[given.logarithmic ? "factor" : "sd"] =
          given.logarithmic ? std::exp(given.prior_sd) : given.prior_sd;
    }
    parameters.push_back({{"path", c.parameters[i].path},
                          {"unit", c.parameters[i].unit},
                          {"per_unit", unit ? unit->to_si : 1},
                          {"lowest", given.low},
                          {"highest", given.high},
                          {"prior", prior},
                          {"start", given.start},
                          {"value", f.value},
                          {"se", f.se},
                          {"low", f.low},
                          {"high", f.high},
                          {"low_open", f.low_open},
                          {"high_open", f.high_open},
                          {"at_bound", f.at_bound},
                          {"data_share", f.data_share}});
  }
  for (const FitDirection& d : r.fit.directions)
    directions.push_back({{"singular_value", d.singular_value}, {"weights", d.weights}});
  for (std::size_t i = 0; i < r.rows.size(); ++i) {
    const FitRow& row = r.rows[i];
    rows.push_back({{"source", row.source},
                    {"what", row.what},
                    {"low", number(row.low)},
                    {"high", number(row.high)},
                    {"sd", row.sd},
                    {"sampling_sd", row.sampling_sd},
                    {"before", row.before},
                    {"after", row.after},
                    {"residual", r.fit.residuals[i]}});
  }
  for (std::size_t i = 0; i < r.claims_after.size(); ++i) {
    const ClaimResult& b = r.claims_after[i];
    claims.push_back({{"id", b.claim->id},
                      {"statement", b.claim->statement},
                      {"fitted", is_fitted(c, b.claim->id)},
                      {"held_before", holds(r.claims_before[i])},
                      {"holds", holds(b)},
                      {"before", r.claims_before[i].papilla.model},
                      {"after", b.papilla.model},
                      {"model", number(b.papilla.value)},
                      {"se", number(b.papilla.se)}});
  }
  return Json{{"schema", 1},
              {"title", c.title},
              {"converged", r.fit.converged},
              {"warning", calibration_warning(r)},
              {"chi2_before", r.chi2_before},
              {"chi2", r.fit.chi2},
              {"prior_chi2", r.fit.prior_chi2},
              {"degrees_of_freedom", r.fit.degrees_of_freedom},
              {"variance_factor", r.fit.variance_factor},
              {"evaluations", r.evaluations},
              {"parameters", parameters},
              {"correlation", r.fit.correlation},
              {"directions", directions},
              {"check_skins", c.check.skins},
              {"residuals", rows},
              {"claims", claims},
              {"gap_by_capacitance", {{"before", r.gap_before}, {"after", r.gap_after}}},
              {"friction_coefficient", r.friction_coefficient}}
      .dump(2);
}

}  // namespace papilla
