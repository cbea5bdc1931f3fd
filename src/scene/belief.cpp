#include "scene/belief.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string_view>
#include <tuple>

#include "base/cache.h"
#include "base/constants.h"
#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "config/describe.h"
#include "config/reader.h"
#include "config/writer.h"

namespace papilla::scene {
namespace {

constexpr const char* kAllWater = "water.scale";
// Decimals that people give weights with.
constexpr double kSumTolerance = 2e-3;

// What a member may set: all of the finger but what an experiment chooses and what describes fits.
struct Settable {
  MemberScene scene;
  double water_scale = 1;
};
constexpr std::array<std::string_view, 7> kNotSettable{
    "name", "state", "load", "fitted_to", "uncertainty", "calibrated_for", "belief"};

void flatten(const Node& table, const std::string& path, std::vector<BeliefValue>& out) {
  for (const Node& child : table.children) {
    const std::string full = path.empty() ? child.key : path + "." + child.key;
    if (child.is_table())
      flatten(child, full, out);
    else
      out.push_back({full, child});
  }
}

// Sections in place of dotted names: what the reader reads.
Node nested(const std::vector<BeliefValue>& values) {
  Node root = table_node();
  for (const BeliefValue& v : values) {
    Node* at = &root;
    std::string rest = v.path;
    for (std::size_t dot; (dot = rest.find('.')) != std::string::npos; rest.erase(0, dot + 1)) {
      const std::string part = rest.substr(0, dot);
      if (!at->find(part)) {
        at->set(part, table_node());
        at->find(part)->place = at->find(part)->key_place = v.value.key_place;
      }
      at = at->find(part);
      if (!at->is_table()) break;
    }
    if (at->is_table()) at->set(rest, v.value);
  }
  return root;
}

// Reads values onto a scene; mistakes are added to the problems.
void read_onto(const std::vector<BeliefValue>& values, Settable& out,
               std::vector<Problem>& problems) {
  std::vector<BeliefValue> keys;
  const BeliefValue* scale = nullptr;
  for (const BeliefValue& v : values) {
    const std::string head = v.path.substr(0, v.path.find('.'));
    if (v.path == kAllWater) {
      scale = &v;
    } else if (std::find(kNotSettable.begin(), kNotSettable.end(), head) != kNotSettable.end()) {
      const Place& at = v.value.key_place;
      problems.push_back({at.file, at.line, at.column, v.path,
                          "belief says nothing of it: a condition of the experiment, or of the "
                          "fit itself"});
    } else {
      keys.push_back(v);
    }
  }
  Document document(nested(keys));
  FieldVisitor& visitor = document.open("");
  fields(visitor, out.scene.finger);
  visitor.section({"model", "options of the model"}, out.scene.model);
  document.close();
  if (scale)
    document.number(scale->value, kAllWater, {kAllWater, "", 1e-6, 1e6, ""}, out.water_scale);
  try {
    document.finish();
  } catch (const InputError& error) {
    problems.insert(problems.end(), error.problems().begin(), error.problems().end());
  }
}

std::vector<BeliefValue> read_values(const Node* node, const std::string& key, Document& document) {
  std::vector<BeliefValue> out;
  if (!node) return out;
  if (!node->is_table()) {
    document.problem(
        node->place, key,
        "expected paths and values, { \"skin.rms\" = \"250 nm\" }, got " + describe(*node));
    return out;
  }
  flatten(*node, "", out);
  return out;
}

class BeliefReader {
 public:
  BeliefReader(const std::string& path, const Finger& finger)
      : document_(load_document(path)), finger_(finger) {
    out_.file = path;
  }

  Belief read() {
    document_.take("schema_version");
    if (const Node* node = document_.take("made_of")) {
      if (node->is_text())
        out_.made_of = node->text;
      else
        document_.problem(node->place, "made_of", "expected a text, got " + describe(*node));
    }
    number("samples", 1e9, out_.samples);
    number("effective_samples", 1e9, out_.effective_samples);
    read_readings();
    out_.fitted = read_values(document_.take("fitted"), "fitted", document_);
    read_section(document_, "calibrated_for", out_.calibrated_for);
    read_members();
    check_values();
    document_.finish();
    return std::move(out_);
  }

 private:
  void number(const std::string& key, double most, double& value) {
    if (const Node* node = document_.take(key))
      document_.number(*node, key, {key.c_str(), "", 0, most, ""}, value);
  }

  void read_readings() {
    const Node* list = document_.take("readings");
    if (!list) return;
    if (list->is_array() && std::all_of(list->children.begin(), list->children.end(),
                                        [](const Node& n) { return n.is_text(); })) {
      for (const Node& reading : list->children) out_.readings.push_back(reading.text);
    } else {
      document_.problem(list->place, "readings", "expected a list of texts");
    }
  }

  void read_members() {
    const Node* list = document_.take("member");
    if (!list || !list->is_array() || list->children.empty()) {
      document_.problem_at("member", "expected a list [[member]] with weight, hypothesis and set");
      return;
    }
    double sum = 0;
    for (std::size_t i = 0; i < list->children.size(); ++i) {
      const Node& node = list->children[i];
      out_.members.push_back(member(node, fmt::format("member.{}", i)));
      sum += out_.members.back().weight;
    }
    if (!document_.problems().empty()) return;
    if (std::abs(sum - 1) > kSumTolerance) {
      document_.problem(list->place, "member",
                        fmt::format("the weights sum to {}, not to 1", format_number(sum)));
      return;
    }
    for (BeliefMember& m : out_.members) m.weight /= sum;
  }

  BeliefMember member(const Node& node, const std::string& where) {
    BeliefMember out;
    if (!node.is_table()) {
      document_.problem(node.place, where, "expected weight, hypothesis and set");
      return out;
    }
    bool weighted = false;
    for (const Node& child : node.children) {
      const std::string key = where + "." + child.key;
      if (child.key == "weight") {
        weighted = true;
        if (document_.number(child, key, {"weight", "", 0, 1, ""}, out.weight) && !(out.weight > 0))
          document_.problem(child.place, key, "expected more than 0: leave such a member out");
      } else if (child.key == "hypothesis") {
        if (child.is_text())
          out.hypothesis = child.text;
        else
          document_.problem(child.place, key, "expected a text, got " + describe(child));
      } else if (child.key == "set") {
        out.set = read_values(&child, key, document_);
      } else {
        document_.problem(child.key_place, where,
                          fmt::format("unknown key `{}`; use weight, hypothesis, set", child.key));
      }
    }
    if (!weighted) document_.problem(node.place, where, "missing `weight`");
    return out;
  }

  // Every value against the keys of the finger.
  void check_values() {
    std::vector<Problem> wrong;
    const auto check = [&](const std::vector<BeliefValue>& values) {
      Settable scene{{finger_, finger_.calibrated_for}};
      read_onto(values, scene, wrong);
    };
    check(out_.fitted);
    for (const BeliefMember& m : out_.members) check(m.set);
    for (const Problem& p : wrong) document_.problem({p.file, p.line, p.column}, p.key, p.message);
  }

  Document document_;
  const Finger& finger_;
  Belief out_;
};

bool names(const std::vector<BeliefValue>& values, const std::string& path) {
  // A list is one value, "water.volume"; its numbers are "water.volume.1".
  return std::any_of(values.begin(), values.end(), [&](const BeliefValue& v) {
    return v.path == path || path.starts_with(v.path + ".");
  });
}

Node table_of(const std::vector<BeliefValue>& values) {
  Node out = table_node();
  for (const BeliefValue& v : values) out.set(v.path, v.value);
  return out;
}

// What members may set of a finger, which is all that reading them asks of it.
Finger without_conditions(Finger finger) {
  const Finger any;
  finger.name = any.name, finger.state = any.state, finger.load = any.load;
  finger.fitted_to = any.fitted_to, finger.uncertainty = any.uncertainty;
  return finger;
}

// The belief of a finger, kept while its file and the finger stay: a page asks for those of all
// fingers of a study with every event of a slider, a search for one with every task.
Belief last_read(const Finger& finger) {
  using Key = std::tuple<Finger, std::filesystem::file_time_type, std::uintmax_t>;
  constexpr std::size_t kMost = 16;  // fingers of a population
  static Cache<Key, Belief> kept(kMost, kInfinity);
  std::error_code missing;  // reading says so
  const auto written = std::filesystem::last_write_time(finger.belief, missing);
  const std::uintmax_t size = std::filesystem::file_size(finger.belief, missing);
  return *kept.get({without_conditions(finger), written, size}, 1, [&] {
    return std::make_shared<const Belief>(read_belief(finger.belief, finger));
  });
}

}  // namespace

double Belief::effective_members() const {
  double squares = 0;
  for (const BeliefMember& m : members) squares += square(m.weight);
  return squares > 0 ? 1 / squares : 0;
}

std::string reading_text(double load, double relative_humidity, double voltage, double off,
                         double on) {
  std::string out = fmt::format("{:.6g} N, {:.6g} %", load, 100 * relative_humidity);
  if (on > 0) out += fmt::format(", {:.6g} V", voltage);
  if (off > 0) out += fmt::format(", off {:.6g} N", off);
  if (on > 0) out += fmt::format(", on {:.6g} N", on);
  return out;
}

Belief read_belief(const std::string& path, const Finger& finger) {
  return BeliefReader(path, finger).read();
}

Belief belief_of(const Finger& finger) {
  Belief out = last_read(finger);
  if (!(out.calibrated_for == finger.calibrated_for)) {
    throw InputError({Problem{
        out.file, 0, 0, "calibrated_for",
        fmt::format("its members were found for other model options than those that finger \"{}\" "
                    "was fitted with: make it again (papilla calibrate), or finger.belief = \"\"",
                    finger.name)}});
  }
  return out;
}

std::vector<Problem> belief_problems(const Finger& finger) {
  if (finger.belief.empty()) return {};
  try {
    belief_of(finger);
  } catch (const InputError& error) {
    return error.problems();
  }
  return {};
}

std::string belief_text(const Belief& belief) {
  Node root = table_node();
  root.set("schema_version", integer_node(1));
  if (!belief.made_of.empty()) root.set("made_of", text_node(belief.made_of));
  if (belief.samples > 0) root.set("samples", number_node(belief.samples));
  if (belief.effective_samples > 0)
    root.set("effective_samples", number_node(belief.effective_samples));
  if (!belief.readings.empty()) {
    std::vector<Node> readings;
    for (const std::string& reading : belief.readings) readings.push_back(text_node(reading));
    root.set("readings", array_node(std::move(readings)));
  }
  if (!belief.fitted.empty()) root.set("fitted", table_of(belief.fitted));
  root.set("calibrated_for", to_table(belief.calibrated_for));
  std::vector<Node> members;
  for (const BeliefMember& m : belief.members) {
    Node node = table_node();
    node.set("weight", number_node(m.weight));
    node.set("hypothesis", text_node(m.hypothesis));
    node.set("set", table_of(m.set));
    members.push_back(std::move(node));
  }
  root.set("member", array_node(std::move(members)));
  return write_toml(root);
}

MemberScene with_member(const Belief& belief, const BeliefMember& member, const Finger& finger,
                        const ModelOptions& model) {
  std::vector<Problem> problems;
  Settable fitted{{finger, model}}, moved{{finger, model}};
  read_onto(belief.fitted, fitted, problems);
  read_onto(member.set, moved, problems);
  if (!problems.empty()) throw InputError(problems);
  Finger own = finger;
  const std::vector<NumberField> mine = number_fields(own),
                                 of_fit = number_fields(fitted.scene.finger);
  for (const NumberField& field : number_fields(moved.scene.finger)) {
    if (!names(member.set, field.path) || !names(belief.fitted, field.path)) continue;
    const double now = *find_number_field(mine, field.path).value,
                 then = *find_number_field(of_fit, field.path).value;
    if (now == then || then == 0) continue;
    const double unit = find_unit(field.unit)->to_si;
    *field.value = std::clamp(now * (*field.value / then), field.low * unit, field.high * unit);
  }
  for (double& v : moved.scene.finger.water.volume) v *= moved.water_scale / fitted.water_scale;
  return moved.scene;
}

}  // namespace papilla::scene
