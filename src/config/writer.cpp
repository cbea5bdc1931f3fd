#include "config/writer.h"

#include <fmt/format.h>

#include <cmath>

#include "base/installation.h"
#include "base/units.h"

namespace papilla::config {

TableWriter::TableWriter(const Origins* origins, std::string path) : origins_(origins) {
  stack_.push_back(table_node());
  paths_.push_back(std::move(path));
}

std::string place_text(const Place& place) {
  return place.line > 0 ? fmt::format("{}:{}:{}", place.file, place.line, place.column)
                        : place.file;
}

namespace {

Node quantity_node(const NumberSpec& spec, double si) {
  return *spec.unit && std::isfinite(si) ? text_node(format_quantity(si, spec.unit))
                                         : number_node(si);
}

std::string default_text(Source source, const char* reference) {
  return fmt::format("default ({}{}{})", source_name(source), *reference ? ": " : "", reference);
}

// Where the numbers of a list that were set one by one are from, before what is said of the list: a
// comment that begins with "default" would say that nobody set any.
void name_items(const Origins& origins, const std::string& path, const NumberSpec& spec,
                std::size_t count, std::string& comment) {
  const auto list = origins.find(path);
  std::string single;
  std::size_t named = 0;
  bool in_default_list = false;
  for (std::size_t i = 0; i < count; ++i) {
    const auto found = origins.find(fmt::format("{}.{}", path, i));
    if (found == origins.end()) continue;
    single += fmt::format("{}{}: {}", named++ ? "; " : "", i, place_text(found->second));
    in_default_list |= list != origins.end() && list->second.file == found->second.file;
  }
  if (named == 0) return;
  if (in_default_list) comment = default_text(spec.source, spec.reference);
  comment = named == count ? single : single + "; the others: " + comment;
}

}  // namespace

void TableWriter::add(const char* key, Node value, Source source, const char* reference) {
  if (origins_) {
    const std::string path = paths_.back().empty() ? key : paths_.back() + "." + key;
    if (const auto found = origins_->find(path); found != origins_->end()) {
      value.comment = place_text(found->second);
    } else {
      value.comment = default_text(source, reference);
    }
  }
  stack_.back().set(key, std::move(value));
}

void TableWriter::number(const NumberSpec& spec, double& si) {
  add(spec.key, quantity_node(spec, si), spec.source, spec.reference);
}

void TableWriter::numbers(const NumberSpec& spec, std::vector<double>& si) {
  std::vector<Node> items;
  for (const double value : si) items.push_back(quantity_node(spec, value));
  add(spec.key, array_node(std::move(items)), spec.source, spec.reference);
  if (!origins_) return;
  const std::string path = paths_.back().empty() ? spec.key : paths_.back() + "." + spec.key;
  name_items(*origins_, path, spec, si.size(), stack_.back().find(spec.key)->comment);
}

void TableWriter::integer(const FieldSpec& spec, int, int, int& value) {
  add(spec.key, integer_node(value), spec.source, spec.reference);
}

void TableWriter::flag(const FieldSpec& spec, bool& value) {
  add(spec.key, flag_node(value), spec.source, spec.reference);
}

void TableWriter::text(const FieldSpec& spec, std::string& value) {
  add(spec.key, text_node(value), spec.source, spec.reference);
}

// A TOML file of the shipped designs by its name below them, where readers look for it on any
// machine; other files by their whole path.
void TableWriter::path(const FieldSpec& spec, std::string& value) {
  std::string name = value;
  for (const std::string& root : own_designs()) {
    const std::string folder = root.ends_with('/') ? root : root + "/";
    if (value.ends_with(".toml") && value.starts_with(folder)) name = value.substr(folder.size());
  }
  text(spec, name);
}

void TableWriter::choice(const FieldSpec& spec, const std::vector<std::string>& names, int& value) {
  add(spec.key, text_node(names.at(static_cast<std::size_t>(value))), spec.source, spec.reference);
}

void TableWriter::pop_into_parent() {
  Node node = std::move(stack_.back());
  stack_.pop_back();
  paths_.pop_back();
  if (stack_.back().is_array()) {
    stack_.back().children.push_back(std::move(node));
  } else {
    std::string key = node.key;
    stack_.back().set(std::move(key), std::move(node));
  }
}

bool TableWriter::begin_section(const FieldSpec& spec) {
  Node table = table_node();
  table.key = spec.key;
  paths_.push_back(paths_.back().empty() ? spec.key : paths_.back() + "." + spec.key);
  stack_.push_back(std::move(table));
  return true;
}

void TableWriter::end_section() { pop_into_parent(); }

int TableWriter::begin_list(const FieldSpec& spec, int current, bool&) {
  Node list = array_node({});
  list.key = spec.key;
  paths_.push_back(paths_.back().empty() ? spec.key : paths_.back() + "." + spec.key);
  stack_.push_back(std::move(list));
  return current;
}

bool TableWriter::begin_item(int index) {
  paths_.push_back(fmt::format("{}.{}", paths_.back(), index));
  stack_.push_back(table_node());
  return true;
}

void TableWriter::end_item() { pop_into_parent(); }
void TableWriter::end_list() { pop_into_parent(); }

}  // namespace papilla::config
