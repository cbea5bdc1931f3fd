// What a struct's fields() say about it: the reference of its keys, and its numbers by path
// ("texture.diameter", "surface.dielectric.0.thickness"): the optimiser's design vector.
#pragma once

#include <string>
#include <vector>

#include "config/fields.h"

namespace papilla {

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
  std::string unit;  // limits are in it
  double low = 0, high = 0;
  std::string doc;
  double* value = nullptr;  // SI, within the visited struct
};

class FieldCollector final : public FieldVisitor {
 public:
  explicit FieldCollector(std::string path) : paths_{std::move(path)} {}

  std::vector<FieldRow> rows;
  std::vector<NumberField> numbers_found;

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
  void end_section() override { paths_.pop_back(); }
  int begin_list(const FieldSpec& spec, int current, bool& replace) override;
  bool begin_item(int index) override;
  void end_item() override { paths_.pop_back(); }
  void end_list() override { paths_.pop_back(); }

 private:
  std::string join(const std::string& key) const;
  void add(const FieldSpec& spec, std::string kind, std::string range, std::string value);

  std::vector<std::string> paths_;
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
  FieldCollector collector(path);
  fields(collector, s);
  return collector.numbers_found;
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

}  // namespace papilla
