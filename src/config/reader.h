// Reads a TOML file into structs by their fields(): all problems at once, each with its place.
//
//   Document document = load_document("study.toml", {"texture.depth=350 nm"}, {designs_folder});
//   read_section(document, "texture", texture);
//   finish(document);                                   // throws InputError with every problem
//
// Files: `schema_version = 1`; `base = "other.toml"` puts another file below this one, in the
// file's head or in a section (then the other file holds that section's keys). A base is looked for
// beside the file that names it, then under the search roots, and never outside the first file's
// folder or a root. A section whose `type` differs from its base's replaces it instead of merging.
// A list replaces its base's, too; water.volume.1 = "2 um3" or [surface.dielectric.1] changes one
// item of it, or of the default list where no base has one.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/rooms.h"
#include "config/fields.h"
#include "config/node.h"

namespace papilla::config {

// Where each value that was read came from; a path that is absent has its default. Numbers of a
// list that were set one by one stand beside it (water.volume, water.volume.1): those that come
// from the list's own file were set in a default list, others in a list of that file.
using Origins = std::map<std::string, Place>;

class Document {
 public:
  // Throws nothing; see load_document. roots: where files that its values name are looked for that
  // are not beside them. heads: the file and the bases of its head.
  explicit Document(Node root, std::vector<std::string> roots = {},
                    std::vector<std::string> heads = {});
  ~Document();
  Document(Document&&) noexcept;
  Document& operator=(Document&&) noexcept;

  // The value at a dotted path, or null; it and its members count as read.
  const Node* take(const std::string& path);
  bool has(const std::string& path) const;

  // Reads one number at a node by a spec; false (and a problem at `key`) when it does not fit.
  bool number(const Node& node, const std::string& key, const NumberSpec& spec, double& si);

  void problem(const Place& place, const std::string& key, const std::string& message);
  // At the value of `path` (or its nearest section that is in the file).
  void problem_at(const std::string& path, const std::string& message);

  const Origins& origins() const;
  // Whether a value that was read is the document's own, of its file, a base of its head or an
  // override: not that of a section's base, as a finger's file is one.
  bool own(const std::string& path) const;
  const std::vector<Problem>& problems() const;

  // Visits a struct at `path` ("" = the file's head); see read_section.
  FieldVisitor& open(const std::string& path);
  void close();

  // Asked for the key that an unknown one in a section may stand for, before near names are; "":
  // none.
  void set_hints(
      std::function<std::string(const std::string& key, const std::string& section)> hint);

  // Reports unread keys, then throws InputError if anything was wrong.
  void finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// Throws InputError when a file cannot be read or is not TOML. An override is "path=value"; the
// value is TOML, or else taken as text: texture.depth=350 nm. Of "path:=value" bare numbers are in
// the SI unit of their key: texture.depth:=3.5e-7. List items: surface.dielectric.0.thickness. The
// dots and the = of a path are those outside of brackets and quotes:
// constraints.worst(voltage_for(modulation = 0.5))=150 V. A key in quotes of the file that spells
// several parts, "texture.depth", is the same path.
Document load_document(const std::string& path, const std::vector<std::string>& overrides = {},
                       const std::vector<std::string>& search_roots = {});
// The same from text; `file` stands for it in problems. With search roots its bases are looked for
// in the current folder and below the roots, without it has none.
Document parse_document(const std::string& text, const std::string& file,
                        const std::vector<std::string>& overrides = {},
                        const std::vector<std::string>& search_roots = {});

// Finds a file that `from` names: beside it, then under the roots; empty when there is none there.
std::string find_beside(const std::string& name, const std::string& from,
                        const std::vector<std::string>& search_roots);

template <class S>
void read_section(Document& document, const std::string& path, S& s) {
  fields(document.open(path), s);
  document.close();
}

inline void finish(Document& document) { document.finish(); }

}  // namespace papilla::config
