#include "report/predictions.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "report/json.h"
#include "report/tables.h"

namespace papilla::report {
namespace {

using Json = nlohmann::ordered_json;

std::string value_text(const Prediction& p) {
  std::string out = p.value.se > 0 ? fmt::format("{:.3g} ± {:.2g}", p.value.value, p.value.se)
                                   : fmt::format("{:.3g}", p.value.value);
  if (p.model) out += fmt::format(" numerical ± {:.2g} model", *p.model);
  if (!p.unit.empty()) out += " " + p.unit;
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
      std::any_of(predictions.begin(), predictions.end(), [](const auto& p) { return p.model; })
          ? " (numerical) and a standard deviation over what is not known of finger and model (its "
            "belief)"
          : "; what is not known of finger and model is not in it: the finger names no belief");
  out += markdown_head({"experiment", "condition", "quantity", "prediction", "values"});
  for (const Prediction& p : predictions)
    out += markdown_row({p.id, p.condition, p.quantity, value_text(p), p.beside});
  return out;
}

std::string predictions_csv(const std::vector<Prediction>& predictions) {
  std::string out = "experiment,condition,quantity,unit,value,se,model,values\n";
  for (const Prediction& p : predictions) {
    out += fmt::format("{},{},{},{},{:.6g},{:.3g},{},{}\n", csv_cell(p.id), csv_cell(p.condition),
                       csv_cell(p.quantity), p.unit, p.value.value, p.value.se,
                       p.model ? fmt::format("{:.3g}", *p.model) : "", csv_cell(p.beside));
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
                    {"beside", p.beside}});
  }
  return Json{{"schema", 1}, {"finger", finger}, {"predictions", list}}.dump(2);
}

}  // namespace papilla::report
