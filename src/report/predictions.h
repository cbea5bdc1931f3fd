// Predictions for other laboratories, as tables.
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"
#include "claims/predict.h"

namespace papilla::report {

// For people, Markdown, CSV; JSON as {"schema": 1, "finger", "predictions": [{"id", "condition",
// "quantity", "unit", "value", "se", "model", "beside", "model_note"}]}; model_note: why a number
// has no model part, or of how many members.
std::string predictions_text(const std::vector<Prediction>& predictions);
std::string predictions_markdown(const std::vector<Prediction>& predictions,
                                 const std::string& finger);
std::string predictions_csv(const std::vector<Prediction>& predictions);
std::string predictions_json(const std::vector<Prediction>& predictions, const std::string& finger);

}  // namespace papilla::report
