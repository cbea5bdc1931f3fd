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

// The end of the value that begins at `at`: a text, a list, a table within a line, or a word.
std::size_t end_of_value(const std::string& text, std::size_t at) {
  const auto end_of_text = [&](std::size_t from) {
    const char quote = text[from];
    std::size_t i = from + 1;
    while (i < text.size() && text[i] != quote) i += text[i] == '\\' && quote == '"' ? 2 : 1;
    return std::min(i + 1, text.size());
  };
  if (text[at] == '"' || text[at] == '\'') return end_of_text(at);
  if (text[at] != '[' && text[at] != '{') {
    const std::size_t end = std::min(text.find_first_of(",]}#\n", at), text.size());
    return text.find_last_not_of(" \t\r", end - 1) + 1;
  }
  int depth = 0;
  for (std::size_t i = at; i < text.size(); ++i) {
    if (text[i] == '"' || text[i] == '\'')
      i = end_of_text(i) - 1;
    else if (text[i] == '[' || text[i] == '{')
      ++depth;
    else if ((text[i] == ']' || text[i] == '}') && --depth == 0)
      return i + 1;
  }
  return text.size();
}

bool is_header(const std::string& line) {
  const std::size_t first = line.find_first_not_of(" \t");
  return first != std::string::npos && line[first] == '[';
}

// Without comment and spaces.
std::string bare(const std::string& line) {
  std::string out = line.substr(0, line.find('#'));
  std::erase_if(out, [](char c) { return c == ' ' || c == '\t' || c == '\r'; });
  return out;
}

// The line of a header, from `from` on and before `to`.
std::optional<std::size_t> line_of(const std::vector<std::string>& lines, const std::string& header,
                                   std::size_t from, std::size_t to) {
  for (std::size_t i = from; i < std::min(to, lines.size()); ++i) {
    if (bare(lines[i]) == header) return i;
  }
  return std::nullopt;
}

// Of an item of a list, surface.dielectric.1, the line of its own [[surface.dielectric]]; of a
// section of it the line below that.
std::optional<std::size_t> header_of(const std::vector<std::string>& lines,
                                     const std::string& section) {
  const std::string list = list_of(section);
  if (!list.empty()) {
    const std::string item = section.substr(list.size() + 1), header = "[[" + list + "]]";
    std::optional<std::size_t> own = line_of(lines, header, 0, lines.size());
    for (std::size_t i = std::stoul(item); own && i > 0; --i)
      own = line_of(lines, header, *own + 1, lines.size());
    const std::size_t dot = item.find('.');
    if (own && dot == std::string::npos) return own;
    if (own) {
      const auto next = line_of(lines, header, *own + 1, lines.size());
      return line_of(lines, "[" + list + item.substr(dot) + "]", *own, next.value_or(lines.size()));
    }
  }
  return line_of(lines, "[" + section + "]", 0, lines.size());
}

// One past the last line of a section that says something; begin: the first below its header.
std::size_t end_of_section(const std::vector<std::string>& lines, std::size_t begin) {
  std::size_t out = begin;
  for (std::size_t i = begin; i < lines.size() && !is_header(lines[i]); ++i) {
    const std::size_t first = lines[i].find_first_not_of(" \t\r");
    if (first != std::string::npos && lines[i][first] != '#') out = i + 1;
  }
  return out;
}

// With one more member at the end of the table within a line that begins at `at`.
std::string with_member(std::string text, std::size_t at, const std::string& member) {
  const std::size_t close = end_of_value(text, at) - 1;
  const std::size_t last = text.find_last_not_of(" \t", close - 1);
  if (last != at) return text.insert(last + 1, ", " + member);
  return text.replace(at + 1, close - at - 1, " " + member + " ");
}

// finger.water.load -> finger.water; empty: none.
std::string section_of(const std::string& path) {
  const std::size_t dot = path.rfind('.');
  return dot == std::string::npos ? "" : path.substr(0, dot);
}

// Whether a section that has no header can get none: it is an item of a list, or there by dotted
// keys of a table around it, not by the header of a section below it.
bool takes_dotted_keys(const std::vector<std::string>& lines, const Node& root,
                       const std::string& section) {
  const Node* list = node_at(root, list_of(section));
  if (list && list->is_array()) return true;
  return node_at(root, section) &&
         std::none_of(lines.begin(), lines.end(), [&](const std::string& line) {
           const std::string header = bare(line);
           return header.starts_with("[" + section + ".") ||
                  header.starts_with("[[" + section + ".");
         });
}

// At the end of its section: below its header, in its line, or in the table around it that it is
// part of; a section that is not there comes last.
std::string with_new_key(const std::string& text, const Node& root, const Change& change) {
  std::vector<std::string> lines = lines_of(text);
  const auto with_line = [&](std::size_t begin, const std::string& line) {
    lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(end_of_section(lines, begin)), line);
    return text_of(lines);
  };
  const std::string value = " = " + literal(change.text), section = section_of(change.path);
  const bool dotted = section.empty() || takes_dotted_keys(lines, root, section);
  for (std::string around = section; !around.empty(); around = section_of(around)) {
    const std::string member = change.path.substr(around.size() + 1) + value;
    if (const Node* node = node_at(root, around); node && node->is_table()) {
      const std::size_t at = offset_of(text, node->place);
      if (text[at] == '{') return with_member(text, at, member);
    }
    const auto header = header_of(lines, around);
    if (header && (around == section || dotted)) return with_line(*header + 1, member);
  }
  if (dotted) return with_line(0, change.path + value);
  const std::string gap = text.empty() || text.ends_with("\n\n") ? ""
                          : text.ends_with('\n')                 ? "\n"
                                                                 : "\n\n";
  return text + gap + "[" + section + "]\n" + change.path.substr(section.size() + 1) + value + "\n";
}

// A new kind of texture: what the section said of the old one goes.
std::string without_members(const std::string& text, const std::string& section) {
  std::vector<std::string> lines = lines_of(text);
  const auto header = header_of(lines, section);
  if (!header) return text;
  const auto first = lines.begin() + static_cast<std::ptrdiff_t>(*header + 1);
  lines.erase(first,
              lines.begin() + static_cast<std::ptrdiff_t>(end_of_section(lines, *header + 1)));
  return text_of(lines);
}

// Without the sections that say a list, [[texture.parts]], or items of it.
std::string without_list(const std::string& text, const std::string& list) {
  const std::vector<std::string> lines = lines_of(text);
  std::vector<std::string> out;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::string line = bare(lines[i]);
    if (line == "[[" + list + "]]" || line.starts_with("[" + list + ".") ||
        line.starts_with("[[" + list + ".")) {
      i = end_of_section(lines, i + 1) - 1;
    } else {
      out.push_back(lines[i]);
    }
  }
  return text_of(out);
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
  if (const std::string title = title_of(draft, design); title != design.title)
    out.push_back({"title", toml_string(title)});
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
    if (const std::string rest = node ? without_list(out, change.path) : out; rest != out) {
      out = rest;
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
  const fs::path folder = fs::weakly_canonical(target.parent_path());
  Study study = study_of(draft);
  if (fs::weakly_canonical(draft.file).parent_path() == folder) {
    const std::string text = read_bytes(draft.file);
    return edited_toml(text, local_changes(draft, study.design, folder, parse_toml(text, "")));
  }
  const std::string base = base_name(draft.file, folder);
  // Readers take no base from above the folder of a file: the whole of it then.
  if (base.starts_with("../")) {
    study.design.title = title_of(draft, study.design);
    return resolved_toml(study);
  }
  return edited_toml(fmt::format("schema_version = 1\nbase = \"{}\"\n", base),
                     local_changes(draft, study.design, folder, table_node()));
}

}  // namespace papilla::studio
