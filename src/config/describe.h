// What a struct's fields() say about it: the reference of its keys, and its numbers by path
// ("texture.diameter", "surface.dielectric.0.thickness"): the optimiser's design vector.
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"
#include "config/fields.h"

namespace papilla::config {

struct FieldRow {
  std::string path;
  std::string kind;           // "a length in um", "one of a, b", "true or false", "a section", ...
  std::string range;          // "0.2 to 50 um"; "" where none
  std::string default_value;  // as a file would write it
  std::string doc, source, reference;
  bool required = false;
  bool section = false;  // a section or list: a heading, no value
};

struct NumberField {
  std::string path;
  const char* unit = "";  // limits are in it
  double low = 0, high = 0;
  const char* doc = "";
  double* value = nullptr;  // SI, within the visited struct
};

// Walks a struct and knows the path of the member it is at.
class PathVisitor : public FieldVisitor {
 public:
  explicit PathVisitor(std::string path) : paths_{std::move(path)} {}

 protected:
  bool begin_section(const FieldSpec& spec) override;
  void end_section() override { paths_.pop_back(); }
  int begin_list(const FieldSpec& spec, int current, bool& replace) override;
  bool begin_item(int index) override;
  void end_item() override { paths_.pop_back(); }
  void end_list() override { paths_.pop_back(); }

  std::string join(const char* key) const;
  bool outermost() const { return paths_.size() == 1; }

 private:
  std::vector<std::string> paths_;
};

class FieldCollector final : public PathVisitor {
 public:
  using PathVisitor::PathVisitor;

  std::vector<FieldRow> rows;

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
  int begin_list(const FieldSpec& spec, int current, bool& replace) override;

 private:
  void add(const FieldSpec& spec, std::string kind, std::string range, std::string value);
};

// Numbers alone: quick enough for the inner loop of a search. sections: only those of the outermost
// level; empty: all.
class NumberCollector final : public PathVisitor {
 public:
  explicit NumberCollector(std::string path, std::vector<std::string> sections = {})
      : PathVisitor(std::move(path)), sections_(std::move(sections)) {}

  std::vector<NumberField> found;

  void number(const NumberSpec& spec, double& si) override;
  void numbers(const NumberSpec& spec, std::vector<double>& si) override;
  void integer(const FieldSpec&, int, int, int&) override {}
  void flag(const FieldSpec&, bool&) override {}
  void text(const FieldSpec&, std::string&) override {}
  void path(const FieldSpec&, std::string&) override {}
  void choice(const FieldSpec&, const std::vector<std::string>&, int&) override {}
  using FieldVisitor::choice;

 protected:
  bool begin_section(const FieldSpec& spec) override;

 private:
  std::vector<std::string> sections_;
};

template <class S>
std::vector<FieldRow> field_rows(const S& s, const std::string& path = "") {
  FieldCollector collector(path);
  S copy = s;
  fields(collector, copy);
  return collector.rows;
}

// Every number of a struct, with pointers into it.
template <class S>
std::vector<NumberField> number_fields(S& s, const std::string& path = "") {
  NumberCollector collector(path);
  fields(collector, s);
  return std::move(collector.found);
}
// Those of some of its sections, and those that are in none.
template <class S>
std::vector<NumberField> number_fields_in(S& s, const std::vector<std::string>& sections) {
  NumberCollector collector("", sections);
  fields(collector, s);
  return std::move(collector.found);
}

// The number at a path; throws InputError with a "did you mean" if there is none.
NumberField find_number_field(const std::vector<NumberField>& known, const std::string& path);

template <class S>
NumberField find_number(S& s, const std::string& path) {
  return find_number_field(number_fields(s), path);
}
template <class S>
double get_number(const S& s, const std::string& path) {
  S copy = s;
  return *find_number(copy, path).value;
}
template <class S>
void set_number(S& s, const std::string& path, double si) {
  *find_number(s, path).value = si;
}

std::string reference_text(const std::vector<FieldRow>& rows);      // for a terminal
std::string reference_markdown(const std::vector<FieldRow>& rows);  // one table

}  // namespace papilla::config
