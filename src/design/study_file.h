// A study file while it is read: what its sections share. One function per section, in the files of
// this folder.
#pragma once

#include <list>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "config/reader.h"
#include "design/paths.h"
#include "design/study.h"

namespace papilla::design {

struct StudyFile {
  Document& document;
  Study& study;
  KnownNumbers numbers;
  std::list<Texture> kind_copies;  // that numbers point into

  // The section at a path, kept for resolved.toml; null where there is none, and a mistake where it
  // is no section.
  const Node* section(const std::string& path);
  void keep(const std::string& path);
  // What a base says of a number that its kind of texture has and the one that stands above it has
  // not: it goes with that kind, and the study says so.
  bool falls_away(const std::string& section, const std::string& path, const Node& node);
  // The members of a section by path, as members_by_path has them; a mistake at one that stands
  // twice, in both spellings.
  PathMembers members(const Node& section, const std::string& name,
                      const std::vector<std::string>& whole);
  // A mistake at each key of a section that is not among the names.
  void only(const Node& section, const std::string& path, const std::vector<std::string>& names);
};

void read_design_space(StudyFile& file);
void read_scatter(StudyFile& file);
void read_scenarios(StudyFile& file);
void read_objective(StudyFile& file);
void read_constraints(StudyFile& file);

}  // namespace papilla::design
