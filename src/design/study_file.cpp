#include "design/study_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "base/text.h"
#include "config/writer.h"
#include "design/families.h"
#include "design/words.h"
#include "scene/belief.h"
#include "scene/uncertainty.h"

namespace papilla::design {
namespace {

namespace fs = std::filesystem;

// Of a touch, which is the study's; all else is each finger's own.
constexpr std::array<const char*, 4> kTouch{"load", "state", "touch_time", "belief"};

void touch_as(const Finger& other, const std::string& key, Finger& finger) {
  if (key == "load") finger.load = other.load;
  if (key == "state") finger.state = other.state;
  if (key == "touch_time") finger.touch_time = other.touch_time;
  if (key == "belief") finger.belief = other.belief;
}

// The keys of [finger] that hold for the whole population: those of a touch that the study itself
// says, not the file of its finger; a resolved file, which says all, has a list of them.
std::vector<std::string> shared_touch(StudyFile& file, const Node& section) {
  std::vector<std::string> out;
  const Node* list = section.find("shared");
  if (!list) {
    for (const char* key : kTouch) {
      if (file.document.own(fmt::format("finger.{}", key))) out.emplace_back(key);
    }
    return out;
  }
  for (const Node& item : list->children) {
    const bool known = std::find(kTouch.begin(), kTouch.end(), item.text) != kTouch.end();
    if (known) {
      out.push_back(item.text);
    } else {
      file.document.problem(item.place, "population.shared",
                            "expected one of " + join_names({kTouch.begin(), kTouch.end()}) +
                                ", got " + describe(item));
    }
  }
  if (!list->is_array())
    file.document.problem(list->place, "population.shared", "expected a list of keys of [finger]");
  return out;
}

// What the study itself says of [finger] beyond the touch: no finger of the population has it.
std::vector<std::string> unheard_of(const StudyFile& file) {
  std::vector<std::string> out;
  const Origins& origins = file.document.origins();
  for (const auto& [path, place] : origins) {
    const auto within = origins.lower_bound(path + ".");
    if (within != origins.end() && within->first.starts_with(path + ".")) continue;  // a section
    const bool touch = std::any_of(kTouch.begin(), kTouch.end(), [&](const char* key) {
      return path == fmt::format("finger.{}", key);
    });
    if (path.starts_with("finger.") && path != "finger.name" && !touch && file.document.own(path))
      out.push_back(path);
  }
  return out;
}

void read_population(StudyFile& file) {
  const Node* section = file.section("population");
  if (!section) return;
  file.only(*section, "population", {"fingers", "shared"});
  const Node* list = section->find("fingers");
  if (!list || !list->is_array() || list->children.empty()) {
    file.document.problem(list ? list->place : section->place, "population.fingers",
                          "expected a list of finger files");
    return;
  }
  const std::vector<std::string> shared = shared_touch(file, *section);
  if (!section->find("shared")) file.study.unheard = unheard_of(file);
  std::vector<Node> files;  // absolute, for resolved.toml in another folder
  for (const Node& item : list->children) {
    const std::string name =
        item.is_text() ? find_beside(item.text, item.place.file, design_roots()) : "";
    if (name.empty()) {
      file.document.problem(item.place, "population.fingers",
                            item.is_text()
                                ? fmt::format("no file \"{}\" beside this file or in the "
                                              "designs folder",
                                              item.text)
                                : "expected the name of a file, got " + describe(item));
      continue;
    }
    try {
      Finger finger = read_finger(name);
      for (const std::string& key : shared) touch_as(file.study.design.finger, key, finger);
      file.study.population.push_back(std::move(finger));
      files.push_back(text_node(fs::absolute(name).lexically_normal().string()));
    } catch (const InputError& error) {
      for (const Problem& p : error.problems()) {
        file.document.problem({p.file, p.line, p.column}, p.key, p.message);
      }
    }
  }
  std::vector<Node> keys;
  for (const std::string& key : shared) keys.push_back(text_node(key));
  Node& population = *file.study.study_sections.find("population");
  population.set("fingers", array_node(std::move(files)));
  population.set("shared", array_node(std::move(keys)));
}

// What stands in the head of the file, and the mistakes across its fields.
void read_head(Document& document, Design& design, DesignUse use) {
  read_section(document, "", design);
  if (!document.problems().empty()) return;  // values may stand for ones that could not be read
  for (const DesignProblem& p : design_problems(design, use))
    document.problem_at(p.path, p.message);
  if (const std::string wrong = uncertainty_problem(design.finger); !wrong.empty())
    document.problem_at("finger.uncertainty", wrong);
  for (const Problem& p : belief_problems(design.finger))
    document.problem({p.file, p.line, p.column}, p.key, p.message);
}

void read_search(Document& document, Study& study) {
  read_section(document, "risk", study.risk);
  read_section(document, "search", study.search);
  if (!study.is_study()) return;
  study.study_sections.set("risk", to_table(study.risk, &document.origins(), "risk"));
  study.study_sections.set("search", to_table(study.search, &document.origins(), "search"));
}

void check_whole(Document& document, const Study& study) {
  const Objective& wanted = study.objective;
  const bool misread =
      std::any_of(document.problems().begin(), document.problems().end(),
                  [](const Problem& p) { return p.key.starts_with("objective."); });
  if (study.is_study() && !misread && wanted.maximise.empty() && wanted.minimise.empty() &&
      wanted.targets.empty()) {
    document.problem_at("objective",
                        "a study needs `maximise`, `minimise` or `target`, e.g. maximise = "
                        "\"mean(modulation)\"");
  }
}

std::string study_name(const std::string& path) {
  const fs::path file(path);
  const std::string stem = file.stem().string();
  if (stem != "study" && stem != "resolved" && stem != "design") return stem;
  // The command line takes no name that is no UTF-8, but may stand in a folder of one.
  const std::string folder =
      visible(fs::absolute(file).lexically_normal().parent_path().filename().string());
  return folder.empty() ? stem : folder;
}

}  // namespace

const Node* StudyFile::section(const std::string& path) {
  const Node* node = document.take(path);
  if (!node) return nullptr;
  if (!node->is_table()) {
    document.problem(node->place, path,
                     fmt::format("expected a section [{}], got {}", path, describe(*node)));
    return nullptr;
  }
  keep(path);
  return node;
}

void StudyFile::keep(const std::string& path) {
  if (const Node* node = document.take(path)) study.study_sections.set(path, *node);
}

bool StudyFile::falls_away(const std::string& section, const std::string& path, const Node& node) {
  const auto type = document.origins().find("texture.type");
  const bool asked_for = node.key_place.line == 0;  // on the command line, of this study
  if (asked_for || !path.starts_with("texture.") || numbers.has(path) ||
      type == document.origins().end() || type->second.file == node.key_place.file)
    return false;
  if (!some_kind_has(path)) return false;  // written wrong, whichever kind it is of
  study.fallen_away.push_back(section + "." + path);
  if (Node* kept = study.study_sections.find(section)) erase_member(*kept, path);
  return true;
}

PathMembers StudyFile::members(const Node& section, const std::string& name,
                               const std::vector<std::string>& whole) {
  PathMembers out;
  for (const auto& [path, node] : members_by_path(section, whole)) {
    if (std::any_of(out.begin(), out.end(), [&](const auto& m) { return m.first == path; })) {
      document.problem(node->key_place, name + "." + path,
                       fmt::format("stands twice, as \"{0}\" and as {0}: keep one of them", path));
    } else {
      out.emplace_back(path, node);
    }
  }
  return out;
}

void StudyFile::only(const Node& section, const std::string& path,
                     const std::vector<std::string>& names) {
  for (const Node& child : section.children) {
    if (std::find(names.begin(), names.end(), child.key) != names.end()) continue;
    const std::string near = nearest_name(child.key, names);
    document.problem(child.key_place, path,
                     fmt::format("unknown key `{}`{}", child.key,
                                 near.empty() ? "; known here: " + join_names(names)
                                              : fmt::format(", did you mean `{}`?", near)));
  }
}

namespace {

// What a file is that is no design, by a section that only such files have: who gave it is told
// what takes it, in place of that each of its keys is unknown. "": nothing that is known.
std::string other_kind(const Document& document) {
  constexpr std::array<std::pair<const char*, const char*>, 7> kKinds{{
      {"member", "a belief: a finger names it, belief = \"FILE\""},
      {"parameters",
       "a calibration: `papilla calibrate FILE` takes it, `papilla next FILE` plans "
       "measurements for it"},
      {"instrument", "a lab: `papilla next FOLDER` goes on with it"},
      {"press", "a case of `papilla solve contact`"},
      {"source", "a case of `papilla solve drive`"},
      {"roughness", "a case of `papilla solve persson`"},
      {"macro", "a finger: a design names it in its [finger], base = \"FILE\""},
  }};
  for (const char* of_designs : {"texture", "environment"}) {
    if (document.has(of_designs)) return {};
  }
  const auto* kind = std::find_if(kKinds.begin(), kKinds.end(),
                                  [&](const auto& k) { return document.has(k.first); });
  return kind == kKinds.end() ? "" : kind->second;
}

Study study_of(Document document, const std::string& path, DesignUse use) {
  if (const std::string kind = other_kind(document); !kind.empty())
    throw InputError({Problem{path, 0, 0, "", "no design but " + kind}});
  document.set_hints(key_for_word);
  Study study;
  study.file = path;
  study.name = study_name(path);
  study.study_sections = table_node();
  read_head(document, study.design, use);
  StudyFile file{document, study, KnownNumbers(document, study.design), {}};
  read_design_space(file);
  read_scatter(file);
  read_objective(file);
  read_constraints(file);
  read_population(file);
  read_scenarios(file);
  read_search(document, study);
  check_whole(document, study);
  finish(document);
  study.origins = document.origins();
  return study;
}

}  // namespace

Study read_study(const std::string& path, const std::vector<std::string>& overrides,
                 DesignUse use) {
  const std::string file = own_or_shipped(path);
  return study_of(load_document(file, overrides, design_roots()), file, use);
}

Study parse_study(const std::string& text, const std::string& name,
                  const std::vector<std::string>& overrides, DesignUse use) {
  return study_of(parse_document(text, name, overrides, design_roots()), name, use);
}

Design read_design(const std::string& path, const std::vector<std::string>& overrides) {
  return read_study(path, overrides).design;
}

}  // namespace papilla::design
