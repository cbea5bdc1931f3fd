// How a changed design becomes a file that a person would have written.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "config/node.h"
#include "studio/files.h"

namespace papilla::studio {
namespace {

namespace fs = std::filesystem;

bool is_number(const std::string& text) {
  return !text.empty() &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

// As it stands in a file: bare where TOML takes it so, else as a text.
std::string literal(const std::string& text) {
  try {
    if (parse_toml("value = " + text, "").children.size() == 1) return text;
  } catch (const InputError&) {
  }
  return "\"" + text + "\"";
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> out{""};
  for (const char c : text) {
    if (c == '\n')
      out.emplace_back();
    else
      out.back() += c;
  }
  return out;
}

std::string text_of(const std::vector<std::string>& lines) {
  std::string out;
  for (std::size_t i = 0; i < lines.size(); ++i) out += (i ? "\n" : "") + lines[i];
  return out;
}

const Node* node_at(const Node& root, const std::string& path) {
  const Node* node = &root;
  for (const std::string& part : split(path, '.')) {
    if (node->is_array()) {
      if (!is_number(part) || std::stoul(part) >= node->children.size()) return nullptr;
      node = &node->children[std::stoul(part)];
    } else {
      node = node->find(part);
    }
    if (!node) return nullptr;
  }
  return node;
}

// Bytes of a text up to a place, whose column counts characters.
std::size_t offset_of(const std::string& text, const Place& place) {
  std::size_t at = 0;
  for (int line = 1; line < place.line; ++line) at = text.find('\n', at) + 1;
  for (int column = 1; column < place.column; ++at) {
    const bool last = (static_cast<unsigned char>(text.at(at + 1)) & 0xC0) != 0x80;
    column += last;
  }
  return at;
}

// The end of the value that begins at `at`: a text, a list, or a word.
std::size_t end_of_value(const std::string& text, std::size_t at) {
  const auto end_of_text = [&](std::size_t from) {
    const char quote = text[from];
    std::size_t i = from + 1;
    while (i < text.size() && text[i] != quote) i += text[i] == '\\' && quote == '"' ? 2 : 1;
    return std::min(i + 1, text.size());
  };
  if (text[at] == '"' || text[at] == '\'') return end_of_text(at);
  if (text[at] != '[') {
    const std::size_t end = std::min(text.find_first_of(",]}#\n", at), text.size());
    return text.find_last_not_of(" \t\r", end - 1) + 1;
  }
  int depth = 0;
  for (std::size_t i = at; i < text.size(); ++i) {
    if (text[i] == '"' || text[i] == '\'')
      i = end_of_text(i) - 1;
    else if (text[i] == '[')
      ++depth;
    else if (text[i] == ']' && --depth == 0)
      return i + 1;
  }
  return text.size();
}

bool is_header(const std::string& line) {
  const std::size_t first = line.find_first_not_of(" \t");
  return first != std::string::npos && line[first] == '[';
}

std::optional<std::size_t> header_of(const std::vector<std::string>& lines,
                                     const std::string& section) {
  for (std::size_t i = 0; i < lines.size(); ++i) {
    std::string line = lines[i].substr(0, lines[i].find('#'));
    line.erase(
        std::remove_if(line.begin(), line.end(), [](char c) { return c == ' ' || c == '\r'; }),
        line.end());
    if (line == "[" + section + "]") return i;
  }
  return std::nullopt;
}

// One past the last line of a section that says something.
std::size_t end_of_section(const std::vector<std::string>& lines, std::size_t header) {
  std::size_t end = header + 1, last = header;
  for (; end < lines.size() && !is_header(lines[end]); ++end) {
    const std::size_t first = lines[end].find_first_not_of(" \t\r");
    if (first != std::string::npos && lines[end][first] != '#') last = end;
  }
  return last + 1;
}

std::string with_new_key(const std::string& text, const Node& root, const Change& change) {
  const std::size_t dot = change.path.rfind('.');
  const std::string section = dot == std::string::npos ? "" : change.path.substr(0, dot);
  const std::string line =
      change.path.substr(dot == std::string::npos ? 0 : dot + 1) + " = " + literal(change.text);
  std::vector<std::string> lines = lines_of(text);
  if (const auto header = header_of(lines, section)) {
    lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(end_of_section(lines, *header)), line);
    return text_of(lines);
  }
  if (node_at(root, section)) {
    throw InputError({Problem{"", 0, 0, change.path,
                              "the file has this section within one line: save under another name, "
                              "or write it as [" +
                                  section + "]"}});
  }
  const std::string gap = text.empty() || text.ends_with("\n\n") ? ""
                          : text.ends_with('\n')                 ? "\n"
                                                                 : "\n\n";
  return text + gap + "[" + section + "]\n" + line + "\n";
}

// A new kind of texture: what the section said of the old one goes.
std::string without_members(const std::string& text, const std::string& section) {
  std::vector<std::string> lines = lines_of(text);
  const auto header = header_of(lines, section);
  if (!header) return text;
  const auto first = lines.begin() + static_cast<std::ptrdiff_t>(*header + 1);
  lines.erase(first, lines.begin() + static_cast<std::ptrdiff_t>(end_of_section(lines, *header)));
  return text_of(lines);
}

// A list of which one item changed, as a whole; of what an item has a law for, and the law is none,
// nothing.
Change whole_list(const Design& design, const std::string& list) {
  std::vector<std::string> items;
  std::string index, lawless;
  const std::vector<FormKey> keys = form_keys(design);
  for (const FormKey& key : keys) {
    if (!key.path.starts_with(list + ".")) continue;
    if (key.path.ends_with(".law") && key.value == "none")
      lawless = key.path.substr(0, key.path.rfind('.') + 1);
    if (!lawless.empty() && key.path.starts_with(lawless)) continue;
    if (key.type == KeyType::Numbers && key.value.empty()) continue;
    const std::string rest = key.path.substr(list.size() + 1), at = rest.substr(0, rest.find('.'));
    const std::string member = rest.substr(rest.find('.') + 1) + " = ";
    const bool text = key.type == KeyType::Text || key.type == KeyType::Choice ||
                      (key.type == KeyType::Number && !key.unit.empty());
    const std::string value = key.type == KeyType::Numbers
                                  ? checked_change(keys, key.path, key.value).text
                              : text ? "\"" + key.value + "\""
                                     : key.value;
    if (at != index) items.emplace_back();
    items.back() += (at != index ? "" : ", ") + member + value;
    index = at;
  }
  for (std::string& item : items) item = "{ " + item + " }";
  return {list, "[" + join_names(items, ", ") + "]"};
}

// surface.dielectric.0.thickness -> surface.dielectric; empty: no item of a list.
std::string list_of(const std::string& path) {
  std::string out;
  for (const std::string& part : split(path, '.')) {
    if (is_number(part)) return out;
    out += (out.empty() ? "" : ".") + part;
  }
  return "";
}

// The path of a base as a file in this folder names it.
std::string base_name(const std::string& file, const fs::path& folder) {
  for (const std::string& root : design_roots()) {
    const fs::path below = fs::path(file).lexically_relative(fs::weakly_canonical(root));
    if (!below.empty() && *below.begin() != "..") return below.generic_string();
  }
  return fs::path(file).lexically_relative(folder).generic_string();
}

std::vector<Change> local_changes(const Draft& draft, const Design& design, const fs::path& folder,
                                  const Node& root) {
  std::vector<Change> out;
  for (Change change : draft.changes) {
    if (change.path == "texture.file") {
      const std::string file = design_scan_file(design);
      change.text = "\"" + fs::path(file).lexically_relative(folder).generic_string() + "\"";
    }
    const std::string list = list_of(change.path);
    if (!list.empty() && !node_at(root, list)) change = whole_list(design, list);
    if (std::find(out.begin(), out.end(), change) == out.end()) out.push_back(change);
  }
  return out;
}

}  // namespace

std::string design_scan_file(const Design& design) {
  for (const FormKey& key : form_keys(design)) {
    if (key.path == "texture.file") return key.value;
  }
  return "";
}

std::string edited_toml(const std::string& text, const std::vector<Change>& changes) {
  std::string out = text;
  for (const Change& change : changes) {
    Node root = parse_toml(out, "");
    const Node* node = node_at(root, change.path);
    if (node && change.path == "texture.type" && "\"" + node->text + "\"" != literal(change.text)) {
      out = without_members(out, "texture");
      root = parse_toml(out, "");
      node = node_at(root, change.path);
    }
    if (node && node->place.line > 0) {
      const std::size_t from = offset_of(out, node->place);
      out.replace(from, end_of_value(out, from) - from, literal(change.text));
    } else {
      out = with_new_key(out, root, change);
    }
  }
  return out;
}

std::string saved_text(const Draft& draft, const fs::path& target) {
  const fs::path folder = target.parent_path();
  const Design design = study_of(draft).design;
  if (fs::weakly_canonical(draft.file).parent_path() == fs::weakly_canonical(folder)) {
    const std::string text = read_bytes(draft.file);
    return edited_toml(text, local_changes(draft, design, folder, parse_toml(text, "")));
  }
  const std::string head = fmt::format("schema_version = 1\nbase = \"{}\"\n",
                                       base_name(draft.file, fs::weakly_canonical(folder)));
  return edited_toml(head, local_changes(draft, design, folder, table_node()));
}

}  // namespace papilla::studio
