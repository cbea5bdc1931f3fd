#include "report/sweep.h"

#include <fmt/format.h>

#include "base/units.h"
#include "metrics/metrics.h"
#include "report/response.h"

namespace papilla::report {
namespace {

std::string trouble(const Response& response) {
  const auto said = response.said();
  return said.empty() ? "" : "  " + text(said);
}

std::string haze_column(const Optics& look) {
  return look.refused() ? fmt::format(" {:>8}", "refused")
                        : fmt::format(" {:>8.2f}", 100 * look.haze);
}

}  // namespace

std::string sweep_head(const std::string& path, bool appearance) {
  return fmt::format("{:>16} {:>12} {:>18} {:>14} {:>14}{}\n", path, "F_off mN", "mean modulation",
                     "variation", "worst", appearance ? "   haze %" : "");
}

std::string sweep_line(const std::string& value, const Response& response) {
  const auto column = [&](Summary summary, const Metric& metric, double scale) {
    if (!is_known(metric, response)) return std::string("-");
    const auto v = summarise(summary, metric, response);
    return v ? fmt::format("{:.3f} ±{:.3f}", v->value * scale, v->se * scale) : std::string("-");
  };
  return fmt::format("{:>16} {:>12} {:>18} {:>14} {:>14}", value,
                     column(Summary::Mean, kFriction, 1e3), column(Summary::Mean, kModulation, 1),
                     response.points.size() > 1 ? column(Summary::Variation, kModulation, 1) : "-",
                     column(Summary::Worst, kModulation, 1)) +
         (response.appearance ? haze_column(*response.appearance) : "") + trouble(response) + '\n';
}

std::string sweep_json(const std::string& path, const std::vector<SweepRun>& runs) {
  std::string documents;
  for (const SweepRun& run : runs) {
    documents +=
        fmt::format("{}{{\"value\": {}, \"response\": {}}}", documents.empty() ? "" : ",\n",
                    format_number(run.value), response_json(run.response));
  }
  return fmt::format("{{\"schema\": 1, \"sweep\": \"{}\", \"runs\": [\n{}\n]}}", path, documents);
}

}  // namespace papilla::report
