// A file as a located tree: what the reader reads and the writer writes. Plain values.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/rooms.h"

namespace papilla::config {

struct Place {
  std::string file;  // "--set KEY=VALUE" for the command line; empty: made by the program
  int line = 0;      // 1-based; 0: not known
  int column = 0;
};

struct Node {
  enum class Kind { Table, Array, Text, Integer, Float, Flag, Other };

  Kind kind = Kind::Table;
  std::string key;  // its name within a table
  Place place;      // of the value
  Place key_place;
  std::string text;  // Text: the value; Other: what it is ("a date")
  long long integer = 0;
  double number = 0;  // Integer too
  bool flag = false;
  bool si = false;             // a bare number of it is in the SI unit of its key
  bool not_set = false;        // the default, as a resolved file says
  std::vector<Node> children;  // Table: in the order of the file; Array: items
  std::string comment;         // written behind the value

  bool is_table() const { return kind == Kind::Table; }
  bool is_array() const { return kind == Kind::Array; }
  bool is_text() const { return kind == Kind::Text; }
  bool is_number() const { return kind == Kind::Integer || kind == Kind::Float; }

  const Node* find(std::string_view name) const;
  Node* find(std::string_view name);
  Node& set(std::string name, Node value);  // adds or replaces a member of a table
};

Node text_node(std::string value);
Node number_node(double value);
Node integer_node(long long value);
Node flag_node(bool value);
Node array_node(std::vector<Node> items);
Node table_node();

// `"3 V"`, `3`, `a list`, ...: a value as a message quotes it.
std::string describe(const Node& node);

// The first line of a file that has every value: what is marked as default there was set by nobody.
inline constexpr std::string_view kResolvedHead =
    "# Every value and where it came from; what is marked as default counts as not set.\n";

// TOML text to a tree; every place names `file`. Throws InputError with the place of a syntax
// error.
Node parse_toml(std::string_view text, const std::string& file);
// A tree to TOML text: members before sections, comments behind values.
std::string write_toml(const Node& table);
// A value as it stands behind its key, in its line: tables in braces.
std::string value_toml(const Node& value);
// A text as a string of TOML, in quotes.
std::string toml_string(std::string_view text);

}  // namespace papilla::config
