#include "report/yield.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "base/units.h"
#include "config/describe.h"
#include "geometry/texture.h"
#include "report/json.h"
#include "report/run_numbers.h"

namespace papilla::report {
namespace {

using Json = nlohmann::ordered_json;

// For people: the unit of the number, as keys have it.
std::string unit_of(const Study& study, const std::string& path) {
  Design copy = study.design;
  for (const NumberField& field : number_fields(copy)) {
    if (field.path == path) return field.unit;
  }
  for (const Variable& v : study.variables) {
    if (v.path == path) return v.unit;
    for (std::size_t i = 0; v.is_kind() && i < v.choices.size(); ++i) {
      Texture texture = default_texture(static_cast<std::size_t>(v.choices[i]));
      for (const NumberField& field : number_fields(texture, "texture")) {
        if (field.path == path) return field.unit;
      }
    }
  }
  return "";
}

// In per cent; of more than .1 % to a tenth.
std::string tenths_percent(double share) {
  return share > 0 && share < 0.001 ? "< 0.1 %" : fmt::format("{:.1f} %", 100 * share);
}

constexpr const char* kOfPlates = "counted over plates of the numbers as they were confirmed";
const std::vector<Stage> kOfYield{Stage::Confirm, Stage::Rounding};

// In per cent, or points of it.
std::string share_stated(const std::string& words, const YieldShare& share,
                         const std::string& text) {
  return stated({words, 100 * share.share, "%", {100 * share.error, ""}, {{}, kOfPlates}, kOfYield},
                text);
}

std::string now_stated(const Yield& yield) {
  return share_stated("yield", yield.now, share_text(yield.now.share, yield.now.error));
}

// "min_wall (4.1 %)", the most often broken first.
std::string broken_text(const Study& study, const Yield& yield) {
  std::vector<std::pair<double, std::string>> all;
  if (yield.not_makeable > 0) all.emplace_back(yield.not_makeable, "the shape cannot be made");
  for (std::size_t i = 0; i < yield.broken.size(); ++i) {
    if (yield.broken[i] > 0) all.emplace_back(yield.broken[i], limit_name(study.constraints[i].on));
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<std::string> out;
  for (const auto& [share, name] : all)
    out.push_back(fmt::format(
        "{} ({})", name,
        stated(bare_number("plates that break " + name, 100 * share, "%", kOfPlates, kOfYield),
               tenths_percent(share))));
  return out.empty() ? "" : " Broken by plates: " + join_names(out) + ".";
}

// As the text has it.
std::string scatter_stated(const Study& study, std::size_t k, double share = 1) {
  const Scatter& s = study.scatter[k];
  const std::string unit = unit_of(study, s.path);
  return stated(bare_number((share < 1 ? "half the scatter of " : "scatter of ") + s.path,
                            share * s.tolerance / find_unit(unit)->to_si, unit, "an input", {}),
                tolerance_text(study, k, share));
}

std::string gain_text(const Study& study, const Yield& yield) {
  const auto most = yield.costliest();
  if (!most) {
    return yield.now.share < 1 ? " Halving one tolerance alone gains no more than the error." : "";
  }
  const std::string& path = study.scatter[*most].path;
  const YieldShare& gain = yield.halved[*most];
  return fmt::format(
      " {} costs most: tightening it from {} to {} gains {} points.", path,
      scatter_stated(study, *most), scatter_stated(study, *most, 0.5),
      share_stated("yield that half the scatter of " + path + " gains", gain,
                   fmt::format("{:.1f} ± {:.1f}", 100 * gain.share, 100 * gain.error)));
}

}  // namespace

std::string tolerance_text(const Study& study, std::size_t scatter, double share) {
  const Scatter& s = study.scatter[scatter];
  const std::string unit = unit_of(study, s.path);
  const double shown = share * s.tolerance / find_unit(unit)->to_si;
  return fmt::format("{} {}{}", s.kind == Scatter::Kind::Normal ? "sigma" : "±",
                     significant(shown, 3), unit.empty() ? "" : " " + unit);
}

std::string yield_sentence(const ResultFiles& f) {
  if (!f.result.yield) return {};
  return fmt::format(" Of the plates that scatter as stated {} keep every limit.",
                     now_stated(*f.result.yield));
}

std::string yield_text(const ResultFiles& f) {
  if (!f.result.yield) return {};
  const Yield& yield = *f.result.yield;
  std::vector<std::string> tolerances;
  for (std::size_t k = 0; k < f.study.scatter.size(); ++k)
    tolerances.push_back(f.study.scatter[k].path + " " + scatter_stated(f.study, k));
  return fmt::format("Yield: {} of the plates keep every limit ({}{}).{}{}", now_stated(yield),
                     join_names(tolerances),
                     f.study.correlations.empty() ? "" : ", correlated as stated",
                     broken_text(f.study, yield), gain_text(f.study, yield));
}

Json yield_json(const ResultFiles& f) {
  if (!f.result.yield) return {};
  const Yield& yield = *f.result.yield;
  Json out{{"share", yield.now.share}, {"se", yield.now.error},
           {"plates", yield.plates},   {"not_makeable", yield.not_makeable},
           {"broken", Json::object()}, {"tolerances", Json::array()}};
  for (std::size_t i = 0; i < yield.broken.size(); ++i) {
    const Limited& on = f.study.constraints[i].on;
    if (!std::holds_alternative<YieldLimit>(on)) out["broken"][limit_name(on)] = yield.broken[i];
  }
  for (std::size_t k = 0; k < yield.halved.size(); ++k) {
    const Scatter& s = f.study.scatter[k];
    out["tolerances"].push_back(
        {{"name", s.path},
         {"distribution", s.kind == Scatter::Kind::Normal ? "normal" : "uniform"},
         {"tolerance", s.tolerance},
         {"gain_of_half", {{"value", yield.halved[k].share}, {"se", yield.halved[k].error}}},
         {"text", tolerance_text(f.study, k)}});
  }
  const auto most = yield.costliest();
  out["costliest"] = most ? Json(f.study.scatter[*most].path) : Json();
  out["said"] = yield_text(f);
  return out;
}

}  // namespace papilla::report
