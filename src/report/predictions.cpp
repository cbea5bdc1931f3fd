#include "report/predictions.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "report/json.h"
#include "report/tables.h"

namespace papilla::report {
namespace {

using Json = nlohmann::ordered_json;

// Why a number has no model part, or one of some members alone; "" where all of them have it, and
// for a finger without belief.
std::string model_note(const Prediction& p) {
  if (p.members == 0) return {};
  if (!p.of_finger) return "hangs on no finger";
  if (p.silent == 0) return {};
  return fmt::format("{}: {} of {} members have no answer",
                     p.model ? fmt::format("model part of {} members", p.members - p.silent)
                             : "model part not known",
                     p.silent, p.members);
}

std::string value_text(const Prediction& p) {
  std::string out = p.value.se > 0 ? fmt::format("{:.3g} ± {:.2g}", p.value.value, p.value.se)
                                   : fmt::format("{:.3g}", p.value.value);
  if (p.model)
    out += fmt::format("{} ± {:.2g} model", p.value.se > 0 ? " numerical" : "", *p.model);
  if (!p.unit.empty()) out += " " + p.unit;
  if (const std::string note = model_note(p); !note.empty()) out += " (" + note + ")";
  return out;
}

}  // namespace

std::string predictions_text(const std::vector<Prediction>& predictions) {
  std::string out;
  for (const Prediction& p : predictions) {
    out += fmt::format("{:<46} {} {}\n", p.id, p.quantity, value_text(p));
    out += fmt::format("      {}{}{}\n", p.condition, p.beside.empty() ? "" : "; ", p.beside);
  }
  return out;
}

std::string predictions_markdown(const std::vector<Prediction>& predictions,
                                 const std::string& finger) {
  std::string out = fmt::format(
      "# Predictions\n\nWritten by `papilla predict --out` for the finger \"{}\": what no fit has "
      "seen, before any comparison. ± is one standard error over skins{}.\n\n",
      finger,
      std::any_of(predictions.begin(), predictions.end(), [](const auto& p) { return p.members; })
          ? " (numerical) and a standard deviation over what is not known of finger and model (its "
            "belief)"
          : "; what is not known of finger and model is not in it: the finger names no belief");
  out += markdown_head({"experiment", "condition", "quantity", "prediction", "values"});
  for (const Prediction& p : predictions)
    out += markdown_row({p.id, p.condition, p.quantity, value_text(p), p.beside});
  return out;
}

std::string predictions_csv(const std::vector<Prediction>& predictions) {
  std::string out = "experiment,condition,quantity,unit,value,se,model,values,model_note\n";
  for (const Prediction& p : predictions) {
    out += fmt::format("{},{},{},{},{:.6g},{:.3g},{},{},{}\n", csv_cell(p.id),
                       csv_cell(p.condition), csv_cell(p.quantity), p.unit, p.value.value,
                       p.value.se, p.model ? fmt::format("{:.3g}", *p.model) : "",
                       csv_cell(p.beside), csv_cell(model_note(p)));
  }
  return out;
}

std::string predictions_json(const std::vector<Prediction>& predictions,
                             const std::string& finger) {
  Json list = Json::array();
  for (const Prediction& p : predictions) {
    list.push_back({{"id", p.id},
                    {"condition", p.condition},
                    {"quantity", p.quantity},
                    {"unit", p.unit},
                    {"value", json_number(p.value.value)},
                    {"se", json_number(p.value.se)},
                    {"model", json_number(p.model)},
                    {"beside", p.beside},
                    {"model_note", model_note(p)}});
  }
  return Json{{"schema", 1}, {"finger", finger}, {"predictions", list}}.dump(2);
}

}  // namespace papilla::report
