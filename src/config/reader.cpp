#include "config/reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <set>
#include <string_view>
#include <tuple>

#include "base/check.h"
#include "base/files.h"
#include "base/text.h"
#include "base/units.h"

namespace papilla::config {
namespace {

namespace fs = std::filesystem;

std::string join_path(const std::string& path, const std::string& key) {
  return path.empty() ? key : path + "." + key;
}

// The first place from `from` on that has the letter outside of quotes and brackets, as the last
// dot of constraints.worst(voltage_for(modulation = 0.5)) is not; npos: none has.
std::size_t find_outside(std::string_view text, char letter, std::size_t from = 0) {
  int open = 0;
  bool quoted = false;
  for (std::size_t i = from; i < text.size(); ++i) {
    if (open == 0 && !quoted && text[i] == letter) return i;
    if (text[i] == '"') quoted = !quoted;
    if (!quoted && text[i] == '(') ++open;
    if (!quoted && text[i] == ')' && open > 0) --open;
  }
  return std::string_view::npos;
}

std::vector<std::string> split_path(const std::string& path) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0, end = 0; begin < path.size(); begin = end + 1) {
    end = std::min(find_outside(path, '.', begin), path.size());
    std::string part = path.substr(begin, end - begin);
    if (part.size() > 2 && part.front() == '"' && part.back() == '"')
      part = part.substr(1, part.size() - 2);
    parts.push_back(std::move(part));
  }
  return parts;
}

// As lists are counted: 0, 1, ...; no zero before another digit.
bool is_index(const std::string& part) {
  return !part.empty() && part.size() < 6 && (part.size() == 1 || part.front() != '0') &&
         part.find_first_not_of("0123456789") == std::string::npos;
}

// A table { 0 = ..., 2 = ... } that stands for single items of a list.
bool names_items(const Node& node) {
  return node.is_table() && !node.children.empty() &&
         std::all_of(node.children.begin(), node.children.end(),
                     [](const Node& child) { return is_index(child.key); });
}

// "" where the list has the item.
std::string missing_item(const std::string& index, std::size_t count) {
  if (is_index(index) && std::stoul(index) < count) return {};
  return fmt::format("no item {} in a list of {}", index, count);
}

const Node* find_path(const Node& root, const std::string& path) {
  const Node* node = &root;
  for (const std::string& part : split_path(path)) {
    if (node->is_array()) {
      const std::size_t index = is_index(part) ? std::stoul(part) : node->children.size();
      node = index < node->children.size() ? &node->children[index] : nullptr;
    } else {
      node = node->find(part);
    }
    if (!node) return nullptr;
  }
  return node;
}

constexpr std::array<std::string_view, 9> kMapEndings{".gsf", ".npy", ".exr", ".tif", ".tiff",
                                                      ".x3p", ".gwy", ".sur", ".sdf"};

// What somebody means who names a folder: of designs, or of the results of a search.
constexpr std::array<const char*, 4> kFilesOfAFolder{"design.toml", "study.toml", "best/build.toml",
                                                     "resolved.toml"};

std::string read_text(const std::string& path) {
  constexpr std::uintmax_t kLargest = 16 << 20;
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) throw InputError({Problem{path, 0, 0, "", "no such file"}});
  if (fs::is_directory(status)) {
    std::vector<std::string> inside;
    for (const char* name : kFilesOfAFolder) {
      if (fs::is_regular_file(fs::path(path) / name, error)) inside.emplace_back(name);
    }
    throw InputError({Problem{path, 0, 0, "",
                              "is a folder, expected a TOML file" +
                                  (inside.empty() ? "" : ": it has " + join_names(inside))}});
  }
  const std::string ending = fs::path(path).extension().string();
  if (std::find(kMapEndings.begin(), kMapEndings.end(), ending) != kMapEndings.end()) {
    throw InputError(
        {Problem{path, 0, 0, "",
                 "is a map of heights, expected a TOML file; `papilla surface " + path +
                     "` shows it, and a design has it as `texture.file` of "
                     "`texture.type = \"measured\"`"}});
  }
  if (!fs::is_regular_file(status)) {
    throw InputError({Problem{path, 0, 0, "", "is no regular file, expected a TOML file"}});
  }
  if (fs::file_size(path, error) > kLargest) {
    throw InputError({Problem{path, 0, 0, "", "larger than 16 MiB, expected a TOML file"}});
  }
  return read_bytes(path, kLargest);
}

// A resolved file reads back to the study that it was written of: the keys that nobody set too.
void mark_defaults(Node& node, const std::vector<std::string>& lines) {
  for (Node& child : node.children) mark_defaults(child, lines);
  if (node.is_table() || node.place.line < 1) return;
  const std::string& line = lines[static_cast<std::size_t>(node.place.line) - 1];
  const std::size_t comment = line.rfind("  # ");
  node.not_set = comment != std::string::npos && line.compare(comment + 4, 9, "default (") == 0;
}

Node parse_file_text(const std::string& text, const std::string& file) {
  if (text.find_first_not_of(" \t\r\n") == std::string::npos) {
    throw InputError(
        {Problem{file, 1, 1, "", "the file is empty, expected `schema_version = 1` and sections"}});
  }
  Node root = parse_toml(text, file);
  root.place = Place{file, 1, 1};
  if (text.starts_with(kResolvedHead)) mark_defaults(root, split(text, '\n'));
  return root;
}

bool same_type(const Node& a, const Node& b) {
  const Node* type_a = a.find("type");
  const Node* type_b = b.find("type");
  return !type_a || !type_b || type_a->text == type_b->text;
}

Node with_items(Node list, Node items, const std::string& path);

// Puts `base` below `top`: members of `top` win, tables merge, and single items of a list go into
// the base's list. path: of both.
void merge_below(Node& top, const Node& base, const std::string& path) {
  if (!same_type(top, base)) return;
  for (const Node& child : base.children) {
    Node* mine = top.find(child.key);
    if (!mine) {
      top.children.push_back(child);
    } else if (mine->is_table() && child.is_table()) {
      merge_below(*mine, child, join_path(path, child.key));
    } else if (child.is_array() && names_items(*mine)) {
      *mine = with_items(child, std::move(*mine), join_path(path, child.key));
    }
  }
}

// A list in which some items are others. Throws InputError for items that it has not.
Node with_items(Node list, Node items, const std::string& path) {
  list.not_set = false;
  for (Node& item : items.children) {
    if (const std::string missing = missing_item(item.key, list.children.size()); !missing.empty())
      throw InputError({Problem{item.key_place.file, item.key_place.line, item.key_place.column,
                                path, missing}});
    Node& below = list.children[std::stoul(item.key)];
    if (item.is_table() && below.is_table()) merge_below(item, below, join_path(path, item.key));
    item.key.clear();
    below = std::move(item);
  }
  return list;
}

bool inside(const fs::path& file, const fs::path& folder) {
  const auto [end, rest] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
  return end == folder.end() || (std::next(end) == folder.end() && end->empty());
}

fs::path canonical(const fs::path& path) {
  std::error_code error;
  const fs::path out = fs::weakly_canonical(path, error);
  return error ? fs::absolute(path).lexically_normal() : out;
}

struct BaseFiles {
  std::vector<fs::path> homes;  // folders of the first file and of those that overrides name
  std::vector<std::string> roots;
  std::vector<fs::path> open;      // chain of files being merged
  std::vector<std::string> heads;  // the first file and the bases of its head, as they are named

  bool allowed(const fs::path& file) const {
    if (std::any_of(homes.begin(), homes.end(),
                    [&](const fs::path& home) { return inside(file, home); }))
      return true;
    return std::any_of(roots.begin(), roots.end(),
                       [&](const std::string& root) { return inside(file, canonical(root)); });
  }

  // Resolves the `base` of a table and of the tables within, nearest first: what a section's own
  // base says stands above what the file's base says of that section. head: the table is a file's;
  // path: of the table, in the file.
  void resolve(Node& table, bool head, const std::string& path) {
    for (Node& child : table.children) {
      if (child.is_table()) resolve(child, false, join_path(path, child.key));
    }
    if (const Node* base = table.find("base"); base && base->is_text()) {
      const Node value = *base;
      std::erase_if(table.children, [](const Node& child) { return child.key == "base"; });
      merge_below(table, read(value, head), path);
    } else if (base) {
      throw InputError({Problem{base->place.file, base->place.line, base->place.column, "base",
                                "expected the name of a file, got " + describe(*base)}});
    }
  }

  Node read(const Node& name, bool head) {
    const auto refuse = [&](const std::string& message) {
      throw InputError(
          {Problem{name.place.file, name.place.line, name.place.column, "base", message}});
    };
    const std::string found = find_beside(name.text, name.place.file, roots);
    if (found.empty()) {
      refuse(fmt::format("no file \"{}\" beside this file or in the designs folder", name.text));
    }
    const fs::path file = canonical(found);
    if (!allowed(file)) {
      refuse(fmt::format(
          "\"{}\" lies outside this file's folder and the designs folder; name a folder "
          "that holds both in PAPILLA_DESIGNS",
          name.text));
    }
    if (std::find(open.begin(), open.end(), file) != open.end()) {
      refuse(fmt::format("\"{}\" is based on itself", name.text));
    }
    Node table = parse_file_text(read_text(file.string()), found);
    if (const Node* version = table.find("schema_version")) {
      if (version->kind != Node::Kind::Integer || version->integer != 1) {
        throw InputError({Problem{found, version->place.line, version->place.column,
                                  "schema_version", "expected 1, got " + describe(*version)}});
      }
      std::erase_if(table.children,
                    [](const Node& child) { return child.key == "schema_version"; });
    }
    if (head) heads.push_back(found);
    open.push_back(file);
    resolve(table, head, "");
    open.pop_back();
    return table;
  }
};

struct Override {
  std::string path;
  Node value;
};

void mark_si(Node& node) {
  node.si = true;
  for (Node& child : node.children) mark_si(child);
}

// Of a text that may be a list of thousands of numbers.
std::string beginning(const std::string& text) {
  constexpr std::size_t kShown = 200;
  if (text.size() <= kShown) return text;
  std::size_t end = kShown;
  while (end > 0 && (text[end] & 0xC0) == 0x80) --end;  // between letters
  return text.substr(0, end) + "...";
}

Override parse_override(const std::string& text) {
  const std::size_t equals = find_outside(text, '=');
  const std::string origin = "--set " + beginning(text);  // each value of a list has it
  if (equals == std::string::npos || equals == 0) {
    throw InputError({Problem{origin, 0, 0, "", "expected KEY=VALUE, e.g. drive.amplitude=150V"}});
  }
  Override out;
  out.path = text.substr(0, equals);
  const bool si = text[equals - 1] == ':';
  if (si) out.path.pop_back();
  while (!out.path.empty() && out.path.back() == ' ') out.path.pop_back();
  std::string value = text.substr(equals + 1);
  while (!value.empty() && value.front() == ' ') value.erase(0, 1);
  try {
    Node table = parse_toml("value = " + value, origin);
    if (table.children.size() != 1) throw InputError("more than one value");
    out.value = std::move(table.children[0]);
  } catch (const InputError&) {
    out.value = text_node(value);  // 350 nm, hole_array: no quotes needed on a command line
  }
  out.value.place = out.value.key_place = Place{origin, 0, 0};
  for (Node& child : out.value.children) child.place = child.key_place = out.value.place;
  if (si) mark_si(out.value);
  return out;
}

// The key of a path's next part in a table. A file may spell several parts as one key in quotes,
// "texture.depth" = [...]: then i is moved on to the last of them.
std::string key_of(const Node& table, const std::vector<std::string>& parts, std::size_t& i) {
  for (std::size_t end = parts.size(); end > i + 1; --end) {
    std::string whole = join_names({parts.begin() + static_cast<std::ptrdiff_t>(i),
                                    parts.begin() + static_cast<std::ptrdiff_t>(end)},
                                   ".");
    if (!table.find(whole)) continue;
    i = end - 1;
    return whole;
  }
  return parts[i];
}

void apply(Node& root, const Override& change) {
  Node* node = &root;
  const std::vector<std::string> parts = split_path(change.path);
  const auto refuse = [&](const std::string& message) {
    throw InputError({Problem{change.value.place.file, 0, 0, change.path, message}});
  };
  if (parts.empty()) refuse("expected a key");
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::string key = key_of(*node, parts, i);
    const bool last = i + 1 == parts.size();
    if (node->is_array()) {
      if (const std::string missing = missing_item(parts[i], node->children.size());
          !missing.empty())
        refuse(missing);
      node->not_set = false;
      Node& item = node->children[std::stoul(parts[i])];
      if (last) item = change.value;
      node = &item;
    } else if (node->is_table()) {
      Node* child = node->find(key);
      if (last) {
        if (child && key == "type" && child->text != change.value.text) {
          // Another kind has other keys; its sections are not the kind's.
          std::erase_if(node->children, [](const Node& member) { return !member.is_table(); });
          child = nullptr;
        }
        Node value = change.value;
        node->set(key, std::move(value));
        return;
      }
      if (!child) {
        Node table = table_node();
        table.place = table.key_place = change.value.place;
        child = &node->set(key, std::move(table));
      }
      node = child;
    } else {
      refuse("has no members");
    }
  }
}

Node with_overrides_and_bases(Node root, const std::vector<std::string>& overrides,
                              BaseFiles* bases) {
  std::vector<Override> changes;
  for (const std::string& text : overrides) changes.push_back(parse_override(text));
  const auto is_base = [](const Override& change) {
    return change.path == "base" || change.path.ends_with(".base");
  };
  for (Override& change : changes) {
    if (!is_base(change)) continue;
    // Of the working folder, as all that a caller names; else beside the main file.
    if (const std::string own = find_beside(change.value.text, "", {}); !own.empty() && bases)
      bases->homes.push_back(canonical(own).parent_path());
    else
      change.value.place.file = root.place.file;
    apply(root, change);
  }
  if (bases) bases->resolve(root, true, "");
  // Kinds first: they clear the keys of the kind before.
  std::stable_partition(changes.begin(), changes.end(),
                        [](const Override& change) { return change.path.ends_with("type"); });
  for (const Override& change : changes) {
    if (!is_base(change)) apply(root, change);
  }
  return root;
}

std::string dimension_of(const char* unit) {
  if (!*unit) return "a plain number";
  return fmt::format("{} in {}", dimension_name(*find_unit(unit)), unit);
}

}  // namespace

std::string find_beside(const std::string& name, const std::string& from,
                        const std::vector<std::string>& search_roots) {
  std::error_code error;
  const auto is_file = [&](const fs::path& path) { return fs::is_regular_file(path, error); };
  const fs::path relative(name);
  if (relative.is_absolute()) return is_file(relative) ? name : "";
  const fs::path folder = from.starts_with("--set ") ? fs::path() : fs::path(from).parent_path();
  if (const fs::path beside = (folder / relative).lexically_normal(); is_file(beside)) {
    return beside.string();
  }
  // A study copied out of the designs folder still finds "../fingers/reference.toml" there.
  fs::path below;
  for (const fs::path& part : relative) {
    if (part != "..") below /= part;
  }
  for (const std::string& root : search_roots) {
    if (const fs::path file = fs::path(root) / below; is_file(file)) return file.string();
  }
  return {};
}

struct Document::State final : public FieldVisitor {
  struct Frame {
    const Node* table;  // null: not in the file
    std::string path;
    bool partial = false;  // stands above an item of a default list, which has the other keys
  };

  Node root;
  std::vector<Problem> problems;
  Origins origins;
  std::map<std::string, std::vector<std::string>> known;  // by table path: keys that have a meaning
  std::map<std::string, const Node*> visited;             // tables whose keys were looked at
  std::vector<Frame> stack;
  std::vector<const Node*> lists;
  std::vector<std::string> roots;  // where files are looked for that are not beside
  std::vector<std::string> heads;
  std::function<std::string(const std::string&, const std::string&)> hint;

  const Frame& frame() const { return stack.back(); }
  bool reading() const override { return true; }

  void problem(const Place& place, const std::string& key, const std::string& message) {
    problems.push_back({place.file, place.line, place.column, key, message});
  }

  // The value of a key of the present table, or null. Reports a required key that is missing.
  // what: makes the words for a key that is missing, which few are.
  template <class Words>
  const Node* value(const char* key, Presence presence, const Words& what) {
    known[frame().path].push_back(key);
    if (!frame().table) return nullptr;
    const Node* node = frame().table->find(key);
    if (node) {
      if (!node->not_set) origins[join_path(frame().path, key)] = node->place;
    } else if (presence == Presence::Required && !frame().partial) {
      problem(frame().table->place, frame().path, fmt::format("missing `{}` ({}", key, what()));
    }
    return node;
  }

  bool convert(const NumberSpec& spec, const Node& node, const std::string& path, double& si) {
    const Unit unit = *find_unit(spec.unit);
    const bool plain = !*spec.unit;
    double result = 0;
    std::string written;
    if (node.is_text()) {
      const auto quantity = parse_quantity(node.text);
      if (!quantity) {
        if (plain) {
          problem(node.place, path, "expected a plain number, got " + describe(node));
        } else {
          problem(node.place, path,
                  fmt::format("expected {}, got {}; write it like \"{} {}\"", dimension_name(unit),
                              describe(node), example(spec), spec.unit));
        }
        return false;
      }
      if (!plain && quantity->unit.empty()) {
        problem(node.place, path, bare_number(quantity->value, spec.unit).advice);
        return false;
      }
      if (!find_unit(quantity->unit)->same_dimension(unit)) {
        problem(node.place, path,
                fmt::format("expected {}, got {}",
                            plain ? std::string("a plain number") : dimension_name(unit),
                            describe(node)));
        return false;
      }
      result = quantity->si;
    } else if (node.is_number()) {
      if (!std::isfinite(node.number)) {
        problem(node.place, path, "expected a finite number, got " + describe(node));
        return false;
      }
      if (!plain && !node.si) {
        problem(node.place, path, bare_number(node.number, spec.unit).advice);
        return false;
      }
      result = node.number;
    } else {
      problem(node.place, path,
              fmt::format("expected {}, got {}", dimension_of(spec.unit), describe(node)));
      return false;
    }
    const double scaled = result / unit.to_si;
    const double slack = 1e-12 * std::max(std::abs(spec.low), std::abs(spec.high));
    if (scaled < spec.low - std::min(slack, 1e-9 * std::abs(spec.low)) ||
        scaled > spec.high + slack) {
      problem(node.place, path,
              fmt::format("{} is outside {} to {}{}{}", format_quantity(result, spec.unit),
                          format_number(spec.low), format_number(spec.high), plain ? "" : " ",
                          spec.unit));
      return false;
    }
    si = result;
    return true;
  }

  static std::string example(const NumberSpec& spec) {
    if (spec.low > 0) return format_number(spec.low);
    return format_number(std::min(1.0, spec.high));
  }

  void number(const NumberSpec& spec, double& si) override {
    const Node* node = value(spec.key, spec.presence, [&] {
      return fmt::format("{}), {}", spec.doc, dimension_of(spec.unit));
    });
    if (node) convert(spec, *node, join_path(frame().path, spec.key), si);
  }

  void numbers(const NumberSpec& spec, std::vector<double>& si) override {
    const Node* node = value(spec.key, spec.presence, [&] {
      return fmt::format("{}), a list, each {}", spec.doc, dimension_of(spec.unit));
    });
    if (!node) return;
    const std::string path = join_path(frame().path, spec.key);
    if (changes_items(*node, path, si.size())) {
      for (std::size_t i = 0; i < si.size(); ++i) {
        const std::string at = fmt::format("{}.{}", path, i);
        const Node* item = node->find(std::to_string(i));
        if (!item) continue;
        origins[at] = item->place;
        convert(spec, *item, at, si[i]);
      }
      return;
    }
    if (!node->is_array()) {
      problem(node->place, path,
              fmt::format(
                  "expected a list, e.g. [{}], got {}",
                  *spec.unit ? fmt::format("\"{} {}\"", example(spec), spec.unit) : example(spec),
                  describe(*node)));
      return;
    }
    std::vector<double> result(node->children.size());
    bool good = true;
    for (std::size_t i = 0; i < result.size(); ++i) {
      const Node& item = node->children[i];
      const std::string at = fmt::format("{}.{}", path, i);
      if (item.place.file != node->place.file) origins[at] = item.place;  // set alone
      good &= convert(spec, item, at, result[i]);
    }
    if (good) si = std::move(result);
  }

  void integer(const FieldSpec& spec, int low, int high, int& out) override {
    const Node* node =
        value(spec.key, spec.presence, [&] { return std::string(spec.doc) + "), a whole number"; });
    if (!node) return;
    const std::string path = join_path(frame().path, spec.key);
    if (node->kind != Node::Kind::Integer) {
      problem(node->place, path, "expected a whole number, got " + describe(*node));
    } else if (node->integer < low || node->integer > high) {
      problem(node->place, path,
              low == high ? fmt::format("expected {}, got {}", low, node->integer)
                          : fmt::format("{} is outside {} to {}", node->integer, low, high));
    } else {
      out = static_cast<int>(node->integer);
    }
  }

  void flag(const FieldSpec& spec, bool& out) override {
    const Node* node =
        value(spec.key, spec.presence, [&] { return std::string(spec.doc) + "), true or false"; });
    if (!node) return;
    if (node->kind != Node::Kind::Flag) {
      problem(node->place, join_path(frame().path, spec.key),
              "expected true or false, got " + describe(*node));
    } else {
      out = node->flag;
    }
  }

  void text(const FieldSpec& spec, std::string& out) override {
    const Node* node =
        value(spec.key, spec.presence, [&] { return std::string(spec.doc) + "), a text"; });
    if (!node) return;
    if (!node->is_text()) {
      problem(node->place, join_path(frame().path, spec.key),
              "expected a text in quotes, got " + describe(*node));
    } else {
      out = node->text;
    }
  }

  void path(const FieldSpec& spec, std::string& out) override {
    const Node* node =
        value(spec.key, spec.presence, [&] { return std::string(spec.doc) + "), a file"; });
    if (!node) return;
    const std::string key = join_path(frame().path, spec.key);
    if (!node->is_text()) {
      problem(node->place, key, "expected the name of a file in quotes, got " + describe(*node));
      return;
    }
    out.clear();
    if (node->text.empty()) return;
    // "scan.gwy::Height": a part of a file.
    const std::size_t part = std::min(node->text.find("::"), node->text.size());
    const std::string found = find_beside(node->text.substr(0, part), node->place.file, roots);
    if (found.empty()) {
      problem(node->place, key, "no such file: " + describe(*node));
    } else {
      out = canonical(found).string() + node->text.substr(part);
    }
  }

  void choice(const FieldSpec& spec, const std::vector<std::string>& names, int& out) override {
    const std::string list = "one of " + join_names(names);
    const Node* node =
        value(spec.key, spec.presence, [&] { return fmt::format("{}), {}", spec.doc, list); });
    if (!node) return;
    const auto found = std::find(names.begin(), names.end(), node->is_text() ? node->text : "");
    if (node->is_text() && found != names.end()) {
      out = static_cast<int>(found - names.begin());
      return;
    }
    const std::string near = node->is_text() ? nearest_name(node->text, names) : "";
    problem(node->place, join_path(frame().path, spec.key),
            fmt::format("expected {}, got {}{}", list, describe(*node),
                        near.empty() ? "" : fmt::format("; did you mean \"{}\"?", near)));
    if (std::string_view(spec.key) != "type") return;
    // The rest is read as of the kind that is most likely meant, so that its mistakes are told at
    // once; which keys go with a kind that nobody knows is unknown too.
    if (near.empty()) {
      ignore_rest_of_table();
    } else {
      out = static_cast<int>(std::find(names.begin(), names.end(), near) - names.begin());
    }
  }

  using FieldVisitor::choice;

  void ignore_rest_of_table() {
    for (const Node& child : frame().table->children) known[frame().path].push_back(child.key);
  }

  void push(const Node* table, const std::string& path, bool partial = false) {
    if (table) visited[path] = table;
    stack.push_back({table, path, partial});
  }

  // Items set one by one (surface.dielectric.0.thickness = "1 um") in a list that the file and its
  // bases leave at its default. Reports indices beyond it.
  bool changes_items(const Node& node, const std::string& path, std::size_t count) {
    if (!names_items(node)) return false;
    for (const Node& child : node.children) {
      if (const std::string missing = missing_item(child.key, count); !missing.empty())
        problem(child.place, path, missing);
    }
    return true;
  }

  bool begin_section(const FieldSpec& spec) override {
    const Node* node =
        value(spec.key, spec.presence, [&] { return std::string(spec.doc) + "), a section"; });
    const std::string path = join_path(frame().path, spec.key);
    if (node && !node->is_table()) {
      problem(node->place, path,
              fmt::format("expected a section [{}], got {}", path, describe(*node)));
      node = nullptr;
    }
    push(node, path);
    return true;
  }

  void end_section() override { stack.pop_back(); }

  int begin_list(const FieldSpec& spec, int current, bool& replace) override {
    const Node* node =
        value(spec.key, spec.presence, [&] { return std::string(spec.doc) + "), a list"; });
    const std::string path = join_path(frame().path, spec.key);
    const bool items = node && changes_items(*node, path, static_cast<std::size_t>(current));
    if (node && !node->is_array() && !items) {
      problem(node->place, path,
              fmt::format("expected a list of sections, [[{}]] or [{{ ... }}], got {}", path,
                          describe(*node)));
      node = nullptr;
    }
    lists.push_back(node);
    stack.push_back({nullptr, path});
    replace = node && !items;
    return replace ? static_cast<int>(node->children.size()) : current;
  }

  bool begin_item(int index) override {
    const Node* list = lists.back();
    const std::string path = fmt::format("{}.{}", frame().path, index);
    const bool partial = list && list->is_table();
    const Node* item = !list     ? nullptr
                       : partial ? list->find(std::to_string(index))
                                 : &list->children[static_cast<std::size_t>(index)];
    if (item && !item->is_table()) {
      problem(item->place, path, "expected a section { ... }, got " + describe(*item));
      item = nullptr;
    }
    push(item, path, partial);
    return true;
  }

  void end_item() override { stack.pop_back(); }

  void end_list() override {
    lists.pop_back();
    stack.pop_back();
  }

  void report_unread() {
    // More tell no more: a file of a million is no design.
    constexpr int kMostTold = 50;
    constexpr std::size_t kLongest = 100;  // of a name that is likened to others
    for (const auto& [path, table] : visited) {
      const std::set<std::string> names(known[path].begin(), known[path].end());
      int unknown = 0;
      const Node* last = nullptr;
      for (const Node& child : table->children) {
        if (names.contains(child.key)) continue;
        last = &child;
        if (++unknown > kMostTold) continue;
        const std::string meant = hint ? hint(child.key, path) : std::string();
        const bool short_key = child.key.size() <= kLongest;
        const std::string near =
            meant.empty() && short_key ? nearest_name(child.key, known[path]) : meant;
        std::string message = fmt::format(
            "unknown key `{}`", short_key ? child.key : child.key.substr(0, kLongest) + "...");
        if (!near.empty()) {
          message += fmt::format(", did you mean `{}`?", near);
        } else {
          message += "; known here: " + join_names({names.begin(), names.end()});
        }
        problem(child.key_place, path, message);
      }
      if (unknown > kMostTold) {
        problem(last->key_place, path,
                fmt::format("the last of {} more unknown keys", unknown - kMostTold));
      }
    }
  }
};

Document::Document(Node root, std::vector<std::string> roots, std::vector<std::string> heads)
    : state_(std::make_unique<State>()) {
  state_->root = std::move(root);
  state_->roots = std::move(roots);
  state_->heads = std::move(heads);
  state_->visited[""] = &state_->root;
}

Document::~Document() = default;
Document::Document(Document&&) noexcept = default;
Document& Document::operator=(Document&&) noexcept = default;

const Node* Document::take(const std::string& path) {
  const std::size_t dot = path.rfind('.');
  const std::string parent = dot == std::string::npos ? "" : path.substr(0, dot);
  state_->known[parent].push_back(dot == std::string::npos ? path : path.substr(dot + 1));
  const Node* node = find_path(state_->root, path);
  if (node && !node->not_set) state_->origins[path] = node->place;
  return node;
}

bool Document::number(const Node& node, const std::string& key, const NumberSpec& spec,
                      double& si) {
  return state_->convert(spec, node, key, si);
}

bool Document::has(const std::string& path) const { return find_path(state_->root, path); }

void Document::problem(const Place& place, const std::string& key, const std::string& message) {
  state_->problem(place, key, message);
}

void Document::problem_at(const std::string& path, const std::string& message) {
  std::string nearest = path;
  const Node* node = find_path(state_->root, nearest);
  while (!node && !nearest.empty()) {
    const std::size_t dot = nearest.rfind('.');
    nearest = dot == std::string::npos ? "" : nearest.substr(0, dot);
    node = find_path(state_->root, nearest);
  }
  state_->problem(node ? node->place : state_->root.place, path, message);
}

const Origins& Document::origins() const { return state_->origins; }

bool Document::own(const std::string& path) const {
  const auto found = state_->origins.find(path);
  if (found == state_->origins.end()) return false;
  const std::vector<std::string>& heads = state_->heads;
  return found->second.line == 0 ||
         std::find(heads.begin(), heads.end(), found->second.file) != heads.end();
}

const std::vector<Problem>& Document::problems() const { return state_->problems; }

FieldVisitor& Document::open(const std::string& path) {
  const Node* node = path.empty() ? &state_->root : take(path);
  if (node && !node->is_table()) {
    problem(node->place, path,
            fmt::format("expected a section [{}], got {}", path, describe(*node)));
    node = nullptr;
  }
  state_->push(node, path);
  return *state_;
}

void Document::close() { state_->stack.pop_back(); }

Document load_document(const std::string& path, const std::vector<std::string>& overrides,
                       const std::vector<std::string>& search_roots) {
  const fs::path file = canonical(path);
  Node root = parse_file_text(read_text(path), path);
  BaseFiles bases{{file.parent_path()}, search_roots, {file}, {path}};
  root = with_overrides_and_bases(std::move(root), overrides, &bases);
  return Document(std::move(root), search_roots, bases.heads);
}

Document parse_document(const std::string& text, const std::string& file,
                        const std::vector<std::string>& overrides,
                        const std::vector<std::string>& search_roots) {
  BaseFiles bases{{fs::current_path()}, search_roots, {}, {file}};
  Node root = with_overrides_and_bases(parse_file_text(text, file), overrides,
                                       search_roots.empty() ? nullptr : &bases);
  return Document(std::move(root), search_roots, bases.heads);
}

void Document::set_hints(
    std::function<std::string(const std::string& key, const std::string& section)> hint) {
  state_->hint = std::move(hint);
}

void Document::finish() {
  state_->report_unread();
  std::vector<Problem>& problems = state_->problems;
  if (problems.empty()) return;
  const std::string& main = state_->root.place.file;
  const auto order = [&](const Problem& p) {
    return std::tuple(p.file != main, p.file, p.line, p.column);
  };
  std::stable_sort(problems.begin(), problems.end(),
                   [&](const Problem& a, const Problem& b) { return order(a) < order(b); });
  throw InputError(problems);
}

}  // namespace papilla::config
