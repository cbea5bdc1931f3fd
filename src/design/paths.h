// Numbers of a design by their path, "texture.diameter": what the sections of a study say of them.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/rooms.h"
#include "config/describe.h"
#include "config/reader.h"
#include "design/design.h"

namespace papilla::design {

struct Setting {
  std::string path;
  double value = 0;  // SI

  bool operator==(const Setting&) const = default;
};

// The design with numbers changed by path (SI). Numbers of the texture that its kind does not have
// are left out.
Design with_settings(Design design, const std::vector<Setting>& settings);

// The members of a section by their full path: "texture.diameter" = ... and texture.diameter = ...
// mean the same. A section with one of the keys of `whole` is one member.
using PathMembers = std::vector<std::pair<std::string, const Node*>>;
PathMembers members_by_path(const Node& section, const std::vector<std::string>& whole = {});

// Takes a member away, by its full path.
void erase_member(Node& section, const std::string& path);

// The numbers that a section may name.
class KnownNumbers {
 public:
  // Both have to outlive this.
  KnownNumbers(Document& document, Design& design);

  bool has(const std::string& path) const;
  // The path of the number that is so called, whole or by its last part; empty: none is.
  std::string named(const std::string& name) const;
  // Numbers of another kind of texture, by paths that are not known yet.
  void add(const std::vector<NumberField>& more);
  // Null, and a mistake at the node, where no number has this path.
  const NumberField* find(const std::string& path, const Node& node, const std::string& where);
  // Reads a value within the number's limits; false, and a mistake, when it does not fit.
  bool read(const NumberField& field, const Node& node, const std::string& where, double& si);

 private:
  Document& document_;
  std::vector<NumberField> numbers_;
};

}  // namespace papilla::design
