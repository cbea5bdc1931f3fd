// Structs back to TOML by their fields().
#pragma once

#include <string>

#include "base/rooms.h"
#include "config/fields.h"
#include "config/node.h"
#include "config/reader.h"

namespace papilla::config {

// Visits a struct and keeps it as a table. With `origins`, each value says where it came from:
// `study.toml:8:10`, the command line, or `default (paper: M3)`.
class TableWriter final : public FieldVisitor {
 public:
  explicit TableWriter(const Origins* origins = nullptr, std::string path = "");

  Node take() { return std::move(stack_.front()); }

  void number(const NumberSpec& spec, double& si) override;
  void numbers(const NumberSpec& spec, std::vector<double>& si) override;
  void integer(const FieldSpec& spec, int low, int high, int& value) override;
  void flag(const FieldSpec& spec, bool& value) override;
  void text(const FieldSpec& spec, std::string& value) override;
  void path(const FieldSpec& spec, std::string& value) override;
  void choice(const FieldSpec& spec, const std::vector<std::string>& names, int& value) override;
  using FieldVisitor::choice;

 protected:
  bool begin_section(const FieldSpec& spec) override;
  void end_section() override;
  int begin_list(const FieldSpec& spec, int current, bool& replace) override;
  bool begin_item(int index) override;
  void end_item() override;
  void end_list() override;

 private:
  void add(const char* key, Node value, Source source, const char* reference);
  void pop_into_parent();

  const Origins* origins_;
  std::vector<Node> stack_;  // open tables and lists, outermost first
  std::vector<std::string> paths_;
};

// A struct as a table, at `path` of the file ("" = the head).
template <class S>
Node to_table(const S& s, const Origins* origins = nullptr, const std::string& path = "") {
  TableWriter writer(origins, path);
  S copy = s;
  fields(writer, copy);
  return writer.take();
}

template <class S>
std::string to_toml(const S& s, const Origins* origins = nullptr) {
  return write_toml(to_table(s, origins));
}

// "study.toml:8:10", "--set texture.depth=1 um".
std::string place_text(const Place& place);

}  // namespace papilla::config
