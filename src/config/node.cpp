#include "config/node.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/units.h"

namespace papilla::config {

const Node* Node::find(std::string_view name) const {
  if (kind != Kind::Table) return nullptr;
  for (const Node& child : children) {
    if (child.key == name) return &child;
  }
  return nullptr;
}

Node* Node::find(std::string_view name) {
  return const_cast<Node*>(static_cast<const Node*>(this)->find(name));
}

Node& Node::set(std::string name, Node value) {
  value.key = std::move(name);
  if (Node* old = find(value.key)) return *old = std::move(value);
  children.push_back(std::move(value));
  return children.back();
}

Node text_node(std::string value) {
  Node node;
  node.kind = Node::Kind::Text;
  node.text = std::move(value);
  return node;
}

Node number_node(double value) {
  Node node;
  node.kind = Node::Kind::Float;
  node.number = value;
  return node;
}

Node integer_node(long long value) {
  Node node;
  node.kind = Node::Kind::Integer;
  node.integer = value;
  node.number = static_cast<double>(value);
  return node;
}

Node flag_node(bool value) {
  Node node;
  node.kind = Node::Kind::Flag;
  node.flag = value;
  return node;
}

Node array_node(std::vector<Node> items) {
  Node node;
  node.kind = Node::Kind::Array;
  node.children = std::move(items);
  return node;
}

Node table_node() { return Node{}; }

std::string describe(const Node& node) {
  switch (node.kind) {
    case Node::Kind::Table:
      return "a section";
    case Node::Kind::Array:
      return "a list";
    case Node::Kind::Text:
      return '"' + node.text + '"';
    case Node::Kind::Integer:
      return std::to_string(node.integer);
    case Node::Kind::Float:
      return format_number(node.number);
    case Node::Kind::Flag:
      return node.flag ? "true" : "false";
    case Node::Kind::Other:
      return node.text;
  }
  return {};
}

std::string toml_string(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (c == '\n') {
      out += "\\n";
    } else if (c == '\t') {
      out += "\\t";
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      out += fmt::format("\\u{:04X}", static_cast<unsigned>(static_cast<unsigned char>(c)));
    } else {
      out += c;
    }
  }
  return out + '"';
}

namespace {

bool bare_key(std::string_view key) {
  return !key.empty() && std::all_of(key.begin(), key.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-';
  });
}

std::string key_text(std::string_view key) {
  return bare_key(key) ? std::string(key) : toml_string(key);
}

std::string value_text(const Node& node) {
  switch (node.kind) {
    case Node::Kind::Text:
    case Node::Kind::Other:
      return toml_string(node.text);
    case Node::Kind::Integer:
      return std::to_string(node.integer);
    case Node::Kind::Float: {
      if (std::isnan(node.number)) return "nan";
      if (std::isinf(node.number)) return node.number > 0 ? "inf" : "-inf";
      std::string text = format_number(node.number);
      if (text.find_first_of(".e") == std::string::npos) text += ".0";
      return text;
    }
    case Node::Kind::Flag:
      return node.flag ? "true" : "false";
    case Node::Kind::Array: {
      std::string out = "[";
      for (const Node& item : node.children) out += (out.size() > 1 ? ", " : "") + value_text(item);
      return out + "]";
    }
    case Node::Kind::Table: {
      std::string out = "{";
      for (const Node& item : node.children) {
        out += (out.size() > 1 ? ", " : " ") + key_text(item.key) + " = " + value_text(item);
      }
      return out + " }";
    }
  }
  return {};
}

bool table_list(const Node& node) {
  return node.is_array() && !node.children.empty() &&
         std::all_of(node.children.begin(), node.children.end(),
                     [](const Node& item) { return item.is_table(); });
}

// Under a key that is a path ("texture.type"), as in [design_space]: it stands in its line, in its
// place among the others, whose order means something.
bool in_its_line(const Node& node) { return node.is_table() && !bare_key(node.key); }

void write_table(const Node& table, const std::string& path, std::string& out) {
  for (const Node& child : table.children) {
    if ((child.is_table() && !in_its_line(child)) || table_list(child)) continue;
    out += key_text(child.key) + " = " + value_text(child);
    if (!child.comment.empty()) out += "  # " + child.comment;
    out += '\n';
  }
  for (const Node& child : table.children) {
    const std::string name = path.empty() ? key_text(child.key) : path + "." + key_text(child.key);
    if (child.is_table() && !in_its_line(child)) {
      out += "\n[" + name + "]\n";
      write_table(child, name, out);
    } else if (table_list(child)) {
      for (const Node& item : child.children) {
        out += "\n[[" + name + "]]\n";
        write_table(item, name, out);
      }
    }
  }
}

}  // namespace

std::string value_toml(const Node& value) { return value_text(value); }

std::string write_toml(const Node& table) {
  std::string out;
  write_table(table, "", out);
  return out;
}

}  // namespace papilla::config
