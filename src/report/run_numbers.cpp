#include "report/run_numbers.h"

#include <fmt/format.h>

#include <cmath>

#include "base/text.h"
#include "base/units.h"
#include "metrics/shown.h"

namespace papilla::report {
namespace {

// Stages that the model part of a score is from.
const std::vector<Stage> kOfScores{Stage::Confirm, Stage::Rounding, Stage::Belief, Stage::Steps};

std::string no_model_part(const ResultFiles& f) {
  const std::string unknown = f.problem.parameters_unknown();
  return unknown.empty() ? "not evaluated for this design ([accuracy] parameters = true does it)"
                         : unknown;
}

StatedError scaled(const std::optional<double>& size, double scale, const std::string& absent) {
  const bool known = size && std::isfinite(*size);
  return {known ? std::optional(*size * scale) : std::nullopt, known ? "" : absent};
}

}  // namespace

StatedNumber objective_number(const ResultFiles& f, const std::string& of, const Score& score,
                              std::size_t k) {
  const StudyObjective& o = f.problem.objectives()[k];
  const ShownUnit shown = shown_unit(o.expression);
  return {o.name + " of " + of,
          score.values[k] * shown.scale,
          shown.unit,
          scaled(k < score.errors.size() ? std::optional(score.errors[k]) : std::nullopt,
                 shown.scale, "not confirmed"),
          scaled(parameter_error(score, k), shown.scale, no_model_part(f)),
          kOfScores};
}

bool scatters(double value, double error) {
  constexpr double kBits = 1e-9;
  return error > kBits * std::abs(value);
}

std::string objective_text(const ResultFiles& f, const std::string& of, const Score& score,
                           std::size_t k) {
  const StudyObjective& o = f.problem.objectives()[k];
  const std::string unit = shown_unit(o.expression).unit;
  const double value = score.values[k];
  std::string out = scatters(value, score.errors[k])
                        ? shown_with_error(o.expression, value, score.errors[k])
                        : shown_value(o.expression, value);
  const auto parameters = parameter_error(score, k);
  if (parameters && scatters(value, *parameters))
    out += fmt::format(" ({})", shown_error(o.expression, *parameters));
  return stated(objective_number(f, of, score, k), out + (unit.empty() ? "" : " " + unit));
}

std::string share_text(double share, double error) {
  // In tenths, as they are shown: what rounds to nothing passes no end.
  const double value = std::round(1e3 * share), bar = std::round(1e3 * error);
  if (value + bar <= 1e3 && value - bar >= 0)
    return fmt::format("{:.1f} ± {:.1f} %", 100 * share, 100 * error);
  const auto end = [](double tenths) {
    return tenths <= 0 ? "0" : tenths >= 1e3 ? "100" : fmt::format("{:.1f}", tenths / 10);
  };
  return end(value - bar) + " to " + end(value + bar) + " %";
}

StatedNumber difference_number(const ResultFiles& f, const std::string& words, const Score& design,
                               const Score& other, std::size_t k) {
  const StudyObjective& o = f.problem.objectives()[k];
  const ShownUnit shown = shown_unit(o.expression);
  return {o.name + ", " + words,
          (design.values[k] - other.values[k]) * shown.scale,
          shown.unit,
          scaled(difference_error(design, other, k), shown.scale, "not confirmed"),
          scaled(parameter_error(design, other, k), shown.scale, no_model_part(f)),
          kOfScores};
}

StatedNumber bare_number(const std::string& words, double value, const std::string& unit,
                         const std::string& no_bar, std::vector<Stage> rests_on) {
  return {words, value, unit, {{}, no_bar}, {{}, no_bar}, std::move(rests_on)};
}

StatedNumber count_number(const std::string& words, std::size_t count,
                          std::vector<Stage> rests_on) {
  return bare_number(words, static_cast<double>(count), "", "a count", std::move(rests_on));
}

StatedNumber whole_text(const std::string& words, const std::string& no_value,
                        std::vector<Stage> rests_on) {
  return bare_number(words, std::nan(""), "", no_value, std::move(rests_on));
}

std::string in_unit(double si, const std::string& unit, int digits) {
  const double shown = si / find_unit(unit)->to_si;
  return significant(shown, digits) + (unit.empty() ? "" : " " + unit);
}

std::string at_most(double si, const std::string& unit) {
  const double to_si = find_unit(unit)->to_si, value = si / to_si;
  if (!(value > 0)) return in_unit(si, unit, 2);
  const double step = std::pow(10, std::floor(std::log10(value)) - 1);
  return in_unit(to_si * step * std::floor(value / step * (1 + 1e-9)), unit, 2);
}

}  // namespace papilla::report
