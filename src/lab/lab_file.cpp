#include "lab/lab_file.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/check.h"
#include "base/error.h"
#include "base/text.h"
#include "config/reader.h"
#include "config/writer.h"
#include "search/prospects.h"

namespace papilla::lab {
namespace {

using Json = nlohmann::ordered_json;

void state_problems(Document& document, const LabFile& file) {
  for (const std::string& state : file.conditions.states) {
    const std::vector<std::string>& names = finger_state_names();
    if (std::find(names.begin(), names.end(), state) == names.end())
      document.problem_at("conditions.states", "\"" + state + "\" is no state of a finger");
  }
}

void risk_problems(Document& document, const LabFile& file) {
  try {
    parse_belief_risk(file.risk);
  } catch (const InputError&) {
    document.problem_at("risk", "\"" + file.risk + "\" is none of the ways to decide: expected " +
                                    belief_risk_forms());
  }
}

void name_problems(Document& document, const LabFile& file) {
  if (file.designs.empty()) document.problem_at("design", "expected one design at least");
  for (std::size_t i = 0; i < file.designs.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (file.designs[i].name == file.designs[j].name)
        document.problem_at("design", "two designs are named " + file.designs[i].name);
    }
  }
  for (const FieldEntry& f : file.fields) {
    const bool known = std::any_of(file.designs.begin(), file.designs.end(),
                                   [&](const DesignEntry& d) { return d.name == f.design; });
    if (!known)
      document.problem_at("field", f.field + " has a design that is not in the list: " + f.design);
  }
}

LabFile lab_of(Document& document) {
  document.take("schema_version");
  LabFile out;
  read_section(document, "", out);
  name_problems(document, out);
  state_problems(document, out);
  risk_problems(document, out);
  document.finish();
  return out;
}

}  // namespace

std::vector<FingerState> finger_states(const CandidateConditions& conditions) {
  const std::vector<std::string>& names = finger_state_names();
  std::vector<FingerState> out;
  for (const std::string& state : conditions.states) {
    const auto found = std::find(names.begin(), names.end(), state);
    PAPILLA_CHECK(found != names.end(), "a lab's states are looked at when it is read");
    out.push_back(static_cast<FingerState>(found - names.begin()));
  }
  return out;
}

std::vector<double> carrier_frequencies(const CandidateConditions& conditions) {
  return conditions.frequency.empty() ? std::vector{0.0} : conditions.frequency;
}

void fields(FieldVisitor& v, CandidateConditions& s) {
  v.numbers({"load", "N", 1e-6, 100, "normal forces that can be set"}, s.load);
  v.numbers({"humidity", "%", 0, 100, "relative humidities that can be set"}, s.humidity);
  v.numbers({"voltage", "V", 0, 1e5, "peak voltages; of each touch friction is read off and on"},
            s.voltage);
  v.numbers({"frequency", "Hz", 0, 1e9, "of the carrier; 0, or none: that of the designs"},
            s.frequency);
  std::string states;
  for (const std::string& one : s.states) states += (states.empty() ? "" : ",") + one;
  v.text({"states", "of the finger: \"clean\", \"clean,natural\""}, states);
  s.states = split(states, ',');
}

void fields(FieldVisitor& v, DesignEntry& s) {
  v.text({"name", "what the plan and tables call it"}, s.name);
  v.text({"file", "its design file, beside this one"}, s.file);
  v.flag({"choice", "one of those that are decided among; else it is measured only"}, s.choice);
}

void fields(FieldVisitor& v, FieldEntry& s) {
  v.text({"field", "label on the wafer"}, s.field);
  v.text({"design", "name of its design"}, s.design);
  v.number({"load", "N", 1e-6, 100, "normal force"}, s.load);
  v.number({"humidity", "%", 0, 100, "relative humidity"}, s.humidity);
  v.number({"voltage", "V", 0, 1e5, "peak"}, s.voltage);
  v.number({"frequency", "Hz", 0, 1e9, "of the carrier; 0: that of its design"}, s.frequency);
  v.choice({"state", "of the finger"}, finger_state_names(), s.state);
}

void fields(FieldVisitor& v, LabFile& s) {
  v.text({"source", "what the lab was opened with"}, s.source);
  v.text({"belief", "members before anything was measured, beside this file"}, s.belief);
  v.text({"worth", "what designs are chosen by, \"worst(modulation)\"; \"\": nothing is decided"},
         s.worth);
  v.text({"worth_file", "worth and limits of the designs at each member, from a run"},
         s.worth_file);
  v.text({"risk", "what decides among designs: \"regret\", or as risk.belief of studies says it"},
         s.risk);
  v.number({"limits", "%", 0, 100, "probability that a choice keeps every limit", Source::Choice,
            "risk.limits of studies"},
           s.limits);
  v.number({"stop", "%", 0, 100, "expected regret, of the best worth, that is not worth measuring",
            Source::Choice, "below what a plate of the same design differs by"},
           s.stop);
  v.number({"discrepancy", "%", 0.1, 200,
            "size of an error of the model that is looked for in the readings", Source::Choice,
            "what closures of the model differ by"},
           s.discrepancy);
  v.section({"instrument", "how readings scatter"}, s.instrument);
  v.section({"costs", "what an experiment takes"}, s.costs);
  v.section({"conditions", "what can be set"}, s.conditions);
  v.list({"design", "what can be measured"}, s.designs);
  v.list({"field", "of a wafer: a design under conditions; none: every design at all conditions"},
         s.fields);
}

LabFile read_lab_file(const std::string& folder) {
  Document document = load_document(folder + "/lab.toml");
  return lab_of(document);
}

std::string lab_file_text(const LabFile& file) {
  return "# Written by papilla next; change what is not so at your bench.\nschema_version = 1\n" +
         to_toml(file);
}

LabFile with_values(const LabFile& file, const std::vector<std::string>& values) {
  static const std::vector<std::string> kOfTheBench{"instrument", "costs", "conditions", "risk",
                                                    "limits",     "stop",  "discrepancy"};
  for (const std::string& value : values) {
    const std::string key = value.substr(0, value.find_first_of(":=")),
                      section = key.substr(0, key.find('.'));
    if (std::find(kOfTheBench.begin(), kOfTheBench.end(), section) == kOfTheBench.end())
      throw InputError(
          {Problem{"lab.toml", 0, 0, key,
                   "is not set like this; of a new lab these are: " + join_names(kOfTheBench)}});
  }
  Document document = parse_document(lab_file_text(file), "lab.toml", values);
  return lab_of(document);
}

std::string run_worth_text(const RunWorth& worth) {
  Json out{{"name", worth.name}, {"designs", worth.designs}, {"worth", Json::array()},
           {"kept", worth.kept}, {"by_skin", worth.by_skin}, {"limits", Json::array()}};
  for (const std::vector<RunLimit>& of_design : worth.limits) {
    Json& limits = out["limits"].emplace_back(Json::object());
    for (const RunLimit& limit : of_design) limits[limit.name] = limit.probability;
  }
  for (const std::vector<double>& row : worth.worth) {
    Json& numbers = out["worth"].emplace_back(Json::array());
    for (const double x : row) numbers.push_back(std::isfinite(x) ? Json(x) : Json(nullptr));
  }
  return out.dump(1) + "\n";
}

RunWorth read_run_worth(const std::string& text, const std::string& file) {
  RunWorth out;
  try {
    const Json j = Json::parse(text);
    out.name = j.at("name");
    out.designs = j.at("designs").get<std::vector<std::string>>();
    out.kept = j.at("kept").get<std::vector<std::vector<bool>>>();
    out.by_skin = j.value("by_skin", std::vector<std::vector<double>>(out.designs.size()));
    for (const Json& of_design : j.value("limits", Json::array())) {
      std::vector<RunLimit>& limits = out.limits.emplace_back();
      for (const auto& [name, probability] : of_design.items())
        limits.push_back({name, probability.get<double>()});
    }
    out.limits.resize(out.designs.size());
    for (const Json& row : j.at("worth")) {
      std::vector<double>& numbers = out.worth.emplace_back();
      for (const Json& x : row) numbers.push_back(x.is_null() ? std::nan("") : x.get<double>());
    }
  } catch (const Json::exception&) {
    throw InputError({Problem{file, 0, 0, "", "not the worth of a run's designs"}});
  }
  const auto right = [&](const auto& rows) {
    return rows.size() == out.designs.size() &&
           std::all_of(rows.begin(), rows.end(), [&](const auto& row) {
             return !rows.empty() && row.size() == rows.front().size();
           });
  };
  if (!right(out.worth) || !right(out.kept) || out.by_skin.size() != out.designs.size() ||
      (!out.worth.empty() && out.worth.front().size() != out.kept.front().size()))
    throw InputError({Problem{file, 0, 0, "", "rows of unlike lengths"}});
  return out;
}

}  // namespace papilla::lab
