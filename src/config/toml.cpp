// The one file that includes toml++.
#include <stdexcept>

// The parser asserts what some broken files violate; that is the file's error, not the end of the
// process.
[[noreturn]] inline void parser_gave_up() { throw std::logic_error("the parser gave up"); }
#undef NDEBUG
#define TOML_ASSERT(expr) ((expr) ? void() : parser_gave_up())
#include <toml++/toml.h>

#include <algorithm>
#include <tuple>

#include "base/error.h"
#include "config/node.h"

namespace papilla {
namespace {

Place place_of(const toml::source_region& source, const std::string& file) {
  return {file, static_cast<int>(source.begin.line), static_cast<int>(source.begin.column)};
}

Node convert(const toml::node& source, const std::string& file) {
  Node node;
  if (const auto* table = source.as_table()) {
    node = table_node();
    for (const auto& [key, value] : *table) {
      Node child = convert(value, file);
      child.key = std::string(key.str());
      child.key_place = place_of(key.source(), file);
      node.children.push_back(std::move(child));
    }
    // toml++ sorts by name; people expect the order of their file.
    std::stable_sort(node.children.begin(), node.children.end(), [](const Node& a, const Node& b) {
      return std::pair(a.key_place.line, a.key_place.column) <
             std::pair(b.key_place.line, b.key_place.column);
    });
  } else if (const auto* array = source.as_array()) {
    node = array_node({});
    for (const auto& value : *array) node.children.push_back(convert(value, file));
  } else if (const auto* text = source.as_string()) {
    node = text_node(text->get());
  } else if (const auto* integer = source.as_integer()) {
    node = integer_node(integer->get());
  } else if (const auto* number = source.as_floating_point()) {
    node = number_node(number->get());
  } else if (const auto* flag = source.as_boolean()) {
    node = flag_node(flag->get());
  } else {
    node = text_node("a date or time");
    node.kind = Node::Kind::Other;
  }
  node.place = place_of(source.source(), file);
  return node;
}

// A dotted key makes one table a dot, and the parser walks them recursively: thousands would end
// the process. Counted over every run of characters that a key can be made of.
void refuse_deep_keys(std::string_view text, const std::string& file) {
  constexpr int kDeepest = 200;
  int line = 1, dots = 0;
  for (char c : text) {
    if (c == '.') {
      if (++dots > kDeepest) {
        throw InputError({Problem{file, line, 1, "", "more than 200 dots in a key"}});
      }
    } else if (c == '\n' || c == '=' || c == ',') {
      dots = 0;
    }
    if (c == '\n') ++line;
  }
}

}  // namespace

Node parse_toml(std::string_view text, const std::string& file) {
  refuse_deep_keys(text, file);
  try {
    const toml::table table = toml::parse(text, std::string_view(file));
    return convert(table, file);
  } catch (const toml::parse_error& error) {
    const Place place = place_of(error.source(), file);
    throw InputError({Problem{file, place.line, place.column, "",
                              "not valid TOML: " + std::string(error.description())}});
  } catch (const std::logic_error& error) {
    throw InputError({Problem{file, 1, 1, "", std::string("not valid TOML: ") + error.what()}});
  }
}

}  // namespace papilla
