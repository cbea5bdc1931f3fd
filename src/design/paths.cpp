#include "design/paths.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/text.h"
#include "design/families.h"

namespace papilla::design {
namespace {

void flatten(const Node& table, const std::string& path, const std::vector<std::string>& whole,
             PathMembers& out) {
  for (const Node& child : table.children) {
    const std::string full = path.empty() ? child.key : path + "." + child.key;
    const bool leaf =
        !child.is_table() || std::any_of(whole.begin(), whole.end(), [&](const std::string& key) {
          return child.find(key) != nullptr;
        });
    if (leaf) {
      out.emplace_back(full, &child);
    } else {
      flatten(child, full, whole, out);
    }
  }
}

}  // namespace

Design with_settings(Design design, const std::vector<Setting>& settings) {
  if (settings.empty()) return design;  // searches ask so of thousands of designs
  const std::vector<NumberField> known = number_fields(design);
  for (const Setting& setting : settings) {
    const std::string path = path_in(known, setting.path);
    if (!path.empty() || !setting.path.starts_with("texture."))
      *find_number_field(known, path.empty() ? setting.path : path).value = setting.value;
  }
  return design;
}

PathMembers members_by_path(const Node& section, const std::vector<std::string>& whole) {
  PathMembers out;
  flatten(section, "", whole, out);
  return out;
}

void erase_member(Node& section, const std::string& path) {
  std::erase_if(section.children, [&](const Node& child) { return child.key == path; });
  for (Node& child : section.children) {
    if (child.is_table() && path.starts_with(child.key + "."))
      erase_member(child, path.substr(child.key.size() + 1));
  }
}

KnownNumbers::KnownNumbers(Document& document, Design& design)
    : document_(document), numbers_(number_fields(design)) {}

bool KnownNumbers::has(const std::string& path) const {
  return std::any_of(numbers_.begin(), numbers_.end(),
                     [&](const NumberField& known) { return known.path == path; });
}

std::string KnownNumbers::named(const std::string& name) const {
  for (const NumberField& known : numbers_) {
    if (known.path == name || known.path.ends_with("." + name)) return known.path;
  }
  return {};
}

void KnownNumbers::add(const std::vector<NumberField>& more) {
  for (const NumberField& field : more) {
    if (std::none_of(numbers_.begin(), numbers_.end(),
                     [&](const NumberField& known) { return known.path == field.path; }))
      numbers_.push_back(field);
  }
}

const NumberField* KnownNumbers::find(const std::string& path, const Node& node,
                                      const std::string& where) {
  for (const NumberField& field : numbers_) {
    if (field.path == path) return &field;
  }
  std::vector<std::string> names;
  for (const NumberField& field : numbers_) names.push_back(field.path);
  const std::string near = nearest_name(path, names);
  document_.problem(
      node.key_place, where,
      near.empty()
          ? fmt::format("`{}` is no number of this design", path)
          : fmt::format("`{}` is no number of this design, did you mean `{}`?", path, near));
  return nullptr;
}

bool KnownNumbers::read(const NumberField& field, const Node& node, const std::string& where,
                        double& si) {
  return document_.number(node, where, {field.path.c_str(), field.unit, field.low, field.high, ""},
                          si);
}

}  // namespace papilla::design
