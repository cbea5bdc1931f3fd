#include "config/describe.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "base/text.h"
#include "base/units.h"

namespace papilla::config {

std::string PathVisitor::join(const char* key) const {
  return paths_.back().empty() ? key : paths_.back() + "." + key;
}

bool PathVisitor::begin_section(const FieldSpec& spec) {
  paths_.push_back(join(spec.key));
  return true;
}

int PathVisitor::begin_list(const FieldSpec& spec, int current, bool&) {
  paths_.push_back(join(spec.key));
  return current;
}

bool PathVisitor::begin_item(int index) {
  paths_.push_back(paths_.back() + "." + std::to_string(index));
  return true;
}

void FieldCollector::add(const FieldSpec& spec, std::string kind, std::string range,
                         std::string value) {
  rows.push_back({join(spec.key), std::move(kind), std::move(range), std::move(value), spec.doc,
                  std::string(source_name(spec.source)), spec.reference,
                  spec.presence == Presence::Required, false});
}

namespace {

FieldSpec plain(const NumberSpec& spec) {
  return {spec.key, spec.doc, spec.source, spec.reference, spec.presence};
}

std::string kind_of(const NumberSpec& spec) {
  if (!*spec.unit) return "a number";
  const std::string_view unit = spec.unit;
  if (unit == "%") return "a share in %";
  return fmt::format("{} in {}", dimension_name(*find_unit(unit)), unit);
}

std::string range_of(const NumberSpec& spec) {
  return fmt::format("{} to {}{}{}", format_number(spec.low), format_number(spec.high),
                     *spec.unit ? " " : "", spec.unit);
}

std::string value_of(const NumberSpec& spec, double si) { return format_quantity(si, spec.unit); }

}  // namespace

void FieldCollector::number(const NumberSpec& spec, double& si) {
  add(plain(spec), kind_of(spec), range_of(spec), value_of(spec, si));
}

void FieldCollector::numbers(const NumberSpec& spec, std::vector<double>& si) {
  std::vector<std::string> values;
  for (double v : si) values.push_back(value_of(spec, v));
  add(plain(spec), "a list, each " + kind_of(spec), range_of(spec),
      fmt::format("[{}]", join_names(values)));
}

void FieldCollector::integer(const FieldSpec& spec, int low, int high, int& value) {
  add(spec, "a whole number",
      low == high ? std::to_string(low) : fmt::format("{} to {}", low, high),
      std::to_string(value));
}

void FieldCollector::flag(const FieldSpec& spec, bool& value) {
  add(spec, "true or false", "", value ? "true" : "false");
}

void FieldCollector::text(const FieldSpec& spec, std::string& value) {
  add(spec, "a text", "", value);
}

void FieldCollector::path(const FieldSpec& spec, std::string& value) {
  add(spec, "a file", "", value);
}

void FieldCollector::choice(const FieldSpec& spec, const std::vector<std::string>& names,
                            int& value) {
  add(spec, "one of " + join_names(names), "", names.at(static_cast<std::size_t>(value)));
}

bool FieldCollector::begin_section(const FieldSpec& spec) {
  add(spec, "a section", "", "");
  rows.back().section = true;
  return PathVisitor::begin_section(spec);
}

int FieldCollector::begin_list(const FieldSpec& spec, int current, bool& replace) {
  add(spec, "a list of sections", "", "");
  rows.back().section = true;
  return PathVisitor::begin_list(spec, current, replace);
}

bool NumberCollector::begin_section(const FieldSpec& spec) {
  const bool kept = !outermost() || sections_.empty() ||
                    std::find(sections_.begin(), sections_.end(), spec.key) != sections_.end();
  PathVisitor::begin_section(spec);
  return kept;
}

void NumberCollector::number(const NumberSpec& spec, double& si) {
  found.push_back({join(spec.key), spec.unit, spec.low, spec.high, spec.doc, &si});
}

void NumberCollector::numbers(const NumberSpec& spec, std::vector<double>& si) {
  for (std::size_t i = 0; i < si.size(); ++i) {
    found.push_back({join(spec.key) + "." + std::to_string(i), spec.unit, spec.low, spec.high,
                     spec.doc, &si[i]});
  }
}

NumberField find_number_field(const std::vector<NumberField>& known, const std::string& path) {
  for (const NumberField& field : known) {
    if (field.path == path) return field;
  }
  std::vector<std::string> names;
  for (const NumberField& field : known) names.push_back(field.path);
  const std::string near = nearest_name(path, names);
  throw InputError({Problem{
      "", 0, 0, path,
      near.empty() ? "no such number in the design"
                   : fmt::format("no such number in the design, did you mean `{}`?", near)}});
}

std::string reference_text(const std::vector<FieldRow>& rows) {
  std::string out;
  for (const FieldRow& row : rows) {
    if (row.section) {
      out += fmt::format("\n[{}]  {}\n", row.path, row.doc);
      continue;
    }
    out += fmt::format("{:<36} {}\n{:<36}   {}", row.path, row.doc, "", row.kind);
    if (!row.range.empty()) out += ", " + row.range;
    if (row.required) {
      out += ", required";
    } else if (!row.default_value.empty()) {
      out += fmt::format(", default {} ({}{}{})", row.default_value, row.source,
                         row.reference.empty() ? "" : ": ", row.reference);
    }
    out += '\n';
  }
  return out;
}

std::string reference_markdown(const std::vector<FieldRow>& rows) {
  std::string out =
      "| key | meaning | kind | range | default | source |\n|---|---|---|---|---|---|\n";
  for (const FieldRow& row : rows) {
    if (row.section) {
      out += fmt::format("| **`{}`** | {} | {} | | | |\n", row.path, row.doc, row.kind);
      continue;
    }
    out += fmt::format(
        "| `{}` | {} | {} | {} | {} | {}{}{} |\n", row.path, row.doc, row.kind, row.range,
        row.required ? "required"
                     : (row.default_value.empty() ? "" : fmt::format("`{}`", row.default_value)),
        row.source, row.reference.empty() ? "" : ": ", row.reference);
  }
  return out;
}

}  // namespace papilla::config
