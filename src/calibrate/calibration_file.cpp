#include "calibrate/calibration_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "config/describe.h"
#include "config/reader.h"
#include "design/design.h"
#include "design/paths.h"
#include "published/targets.h"

namespace papilla::calibrate {
namespace {

// Step of the differences, relative: residuals jump a little where droplets merge or not, and the
// step has to stand above that (docs/theory/calibration.md).
constexpr double kStep = 0.04;

class CalibrationReader {
 public:
  CalibrationReader(Document& document, const std::string& path,
                    const std::vector<std::string>& judged)
      : document_(document), path_(path), judged_(judged.begin(), judged.end()) {}

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
    integer("iterations", 0, 1000, out_.iterations);
    if (const Node* node = document_.take("profiles")) {
      if (node->kind == Node::Kind::Flag) {
        out_.profiles = node->flag;
      } else {
        document_.problem(node->place, "profiles", "expected true or false");
      }
    }
    read_parameters();
    read_belief_section();
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
    from_file("finger", [&](const std::string& file) {
      out_.finger = read_finger(file);
      out_.finger.belief.clear();  // of another fit
    });
  }

  void read_data() {
    std::string finger;
    if (text("data_finger", finger) && !document_.has("data"))
      document_.problem_at("data_finger",
                           "says whose rows of a table are taken, but no table is named: write "
                           "`data = \"measured.csv\"`, or leave data_finger out");
    from_file("data", [&](const std::string& file) {
      FrictionTable table = read_friction(file, finger);
      check_drives(table.rows, file);
      out_.data = std::move(table.rows);
      out_.data_notes = std::move(table.notes);
    });
  }

  void read_lists() {
    std::set<std::string> with_numbers;
    for (const PublishedTarget& t : fittable_targets()) with_numbers.insert(t.claim);
    for (const auto& [key, list] : {std::pair{"fit", &out_.fit}, {"hold_out", &out_.hold_out}}) {
      const Node* node = document_.take(key);
      if (!node) continue;
      if (!node->is_array()) {
        document_.problem(node->place, key, "expected a list of claims, got " + describe(*node));
        continue;
      }
      const bool fitted = list == &out_.fit;
      const std::set<std::string>& allowed = fitted ? with_numbers : judged_;
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

  void read_sampling(const std::string& section, SkinSampling& sampling) {
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

  void read_belief_section() {
    if (document_.has("belief")) {
      out_.belief.emplace();
      read_section(document_, "belief", *out_.belief);
    }
    const Node* list = document_.take("hypothesis");
    if (!list) return;
    if (!out_.belief) {
      document_.problem(list->place, "hypothesis",
                        "hypotheses are weighed in a belief: add a section [belief]");
      return;
    }
    if (!list->is_array()) {
      document_.problem(list->place, "hypothesis",
                        "expected a list [[hypothesis]] of name and set");
      return;
    }
    for (const Node& node : list->children) hypothesis(node);
  }

  void hypothesis(const Node& node) {
    Hypothesis out;
    const std::size_t before = document_.problems().size();
    for (const Node& child : node.children) {
      if (child.key == "name" && child.is_text()) {
        out.name = child.text;
      } else if ((child.key == "set" || child.key == "start") && child.is_table()) {
        std::vector<BeliefValue>& values = child.key == "set" ? out.set : out.start;
        for (const auto& [path, value] : members_by_path(child)) values.push_back({path, *value});
      } else {
        document_.problem(child.key_place, "hypothesis",
                          fmt::format("`{}`: expected `name`, a text, `set` and `start`, paths and "
                                      "values",
                                      child.key));
      }
    }
    if (document_.problems().size() > before) return;
    for (const Hypothesis& other : out_.hypotheses) {
      if (other.name == out.name)
        document_.problem(node.place, "hypothesis", "two of the name \"" + out.name + "\"");
    }
    if (out.name.empty() || out.name == out_.belief->name || out.set.empty())
      document_.problem(node.place, "hypothesis",
                        "expected a name of its own and what it sets: \"model.closure\" = "
                        "\"persson\"");
    for (const BeliefValue& v : out.set) {
      if (is_fitted(v.path))
        document_.problem(v.value.key_place, "hypothesis." + v.path,
                          "is fitted: not to be set; `start` says where its fit begins");
    }
    for (const BeliefValue& v : out.start) {
      if (!is_fitted(v.path))
        document_.problem(v.value.key_place, "hypothesis." + v.path,
                          "is not fitted: `set` sets it");
    }
    if (document_.problems().size() > before) return;
    try {
      under(out_, out);
    } catch (const InputError& error) {
      for (const Problem& p : error.problems())
        document_.problem({p.file, p.line, p.column}, p.key, p.message);
    }
    out_.hypotheses.push_back(std::move(out));
  }

  bool is_fitted(const std::string& path) const {
    return std::any_of(out_.parameters.begin(), out_.parameters.end(),
                       [&](const CalibrationParameter& p) { return p.path == path; });
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

  // What a parameter's section says, beside the numbers.
  struct Given {
    bool low = false, high = false, prior = false, factor = false, sd = false;
  };

  void parameter(const std::string& name, const Node& node, const NumberField& field) {
    const std::string where = "parameters." + name;
    CalibrationParameter p{name, field.unit, {}};
    p.fit.name = name;
    p.fit.start = field.value ? *field.value : 1;
    p.fit.step = kStep;
    if (!node.is_table()) {
      document_.problem(
          node.place, where,
          "expected { low = ..., high = ..., prior = ..., factor = ... or sd = ... }");
      return;
    }
    Given given;
    const std::size_t before = document_.problems().size();
    for (const Node& child : node.children) member(child, where, field, p.fit, given);
    if (document_.problems().size() > before) return;
    if (const std::string wrong = parameter_problem(p, given); !wrong.empty()) {
      document_.problem(node.place, where, wrong);
    } else if (given.prior && (p.fit.prior < p.fit.low || p.fit.prior > p.fit.high)) {
      document_.problem(
          node.find("prior")->place, where + ".prior",
          fmt::format("{} lies outside the bounds {} to {}", format_quantity(p.fit.prior, p.unit),
                      format_quantity(p.fit.low, p.unit), format_quantity(p.fit.high, p.unit)));
    } else {
      out_.parameters.push_back(std::move(p));
    }
  }

  void member(const Node& child, const std::string& where, const NumberField& field,
              FitParameter& fit, Given& given) {
    const std::string path = where + "." + child.key;
    double value = 0;
    const auto reads = [&](const char* unit, double low, double high) {
      return document_.number(child, path, {child.key.c_str(), unit, low, high, ""}, value);
    };
    if (child.key == "low" || child.key == "high" || child.key == "prior" || child.key == "start") {
      if (!reads(field.unit, field.low, field.high)) return;
      if (child.key == "low") {
        fit.low = value;
        given.low = true;
      } else if (child.key == "high") {
        fit.high = value;
        given.high = true;
      } else if (child.key == "start") {
        fit.start = value;
      } else {
        fit.prior = value;
        given.prior = true;
      }
    } else if (child.key == "factor") {
      if (!reads("", 1.0001, 1e6)) return;
      fit.prior_sd = std::log(value);
      fit.logarithmic = given.factor = true;
    } else if (child.key == "sd") {
      if (!reads(field.unit, 0, field.high)) return;
      fit.prior_sd = value;
      given.sd = true;
    } else {
      document_.problem(
          child.key_place, where,
          fmt::format("unknown key `{}`; use low, high, start, prior, and factor or sd",
                      child.key));
    }
  }

  // "" where a parameter makes sense.
  static std::string parameter_problem(const CalibrationParameter& p, const Given& given) {
    const FitParameter& fit = p.fit;
    if (!given.low || !given.high) return "a parameter needs `low` and `high`";
    if (fit.low >= fit.high) return "expected low < high";
    if (given.factor && given.sd) return "a prior has one width: `factor` or `sd`";
    if (given.prior != (given.factor || given.sd))
      return "a prior needs its width: `factor` or `sd`";
    if (given.sd && fit.prior_sd == 0)
      return "expected `sd` above 0: what is known exactly stands in the finger's file";
    if (fit.logarithmic && fit.low <= 0) return "a prior by a factor needs low above 0";
    if (fit.start < fit.low || fit.start > fit.high) {
      return fmt::format("the finger's {} lies outside the bounds",
                         format_quantity(fit.start, p.unit));
    }
    return "";
  }

  Document& document_;
  std::string path_;
  std::set<std::string> judged_;
  Calibration out_;
  std::vector<NumberField> numbers_;
};

}  // namespace

Calibration read_calibration(const std::string& path, const std::vector<std::string>& judged) {
  const std::string file = own_or_shipped(path);
  Document document = load_document(file, {}, design_roots());
  return CalibrationReader(document, file, judged).read();
}

void fields(FieldVisitor& v, BeliefSettings& s) {
  v.text({"name", "of the hypothesis that the finger's own model options are"}, s.name);
  v.integer({"starts", "fits of each hypothesis, from the finger and then drawn from the priors"},
            1, 1000, s.starts);
  v.integer({"iterations", "of each of these fits; a few where `start` is near a minimum"}, 1, 1000,
            s.iterations);
  v.integer({"samples", "draws of each hypothesis, evaluated with the model"}, 10, 1000000,
            s.samples);
  v.integer({"members", "chosen of all draws"}, 2, 1000, s.members);
  v.integer({"seed", "of starts, draws and choice"}, 0, 1 << 30, s.seed);
}

}  // namespace papilla::calibrate
