#include "report/claims.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "report/json.h"

namespace papilla::report {
namespace {

using Json = nlohmann::ordered_json;

std::string cell(const std::string& text) {  // of a CSV table
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string out = "\"";
  for (char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + '"';
}

std::string escaped(std::string text) {  // of a Markdown table
  for (std::size_t i = 0; (i = text.find('|', i)) != std::string::npos; i += 2) {
    text.insert(i, 1, '\\');
  }
  return text;
}

// What each kind of claim can prove differs, so they are counted apart.
std::string counts_text(const std::vector<ClaimResult>& results) {
  std::string out;
  for (const Basis basis : kBases) {
    std::string verdicts;
    int all = 0;
    for (const Verdict verdict : kVerdicts) {
      const auto count = std::count_if(results.begin(), results.end(), [&](const ClaimResult& r) {
        return r.claim->basis == basis && r.papilla.verdict == verdict;
      });
      all += static_cast<int>(count);
      if (count > 0) verdicts += fmt::format(", {} {}", count, verdict_name(verdict));
    }
    if (all > 0)
      out += fmt::format("{}{} {}{}", out.empty() ? "" : "; ", all, basis_name(basis), verdicts);
  }
  return out;
}

std::string single_text(const Judgement& j) {
  return j.single ? fmt::format("all of it on {:.0f} % of single patches", 100 * *j.single) : "";
}

}  // namespace

std::string claims_text(const std::vector<ClaimResult>& results) {
  std::string out;
  for (const ClaimResult& r : results) {
    out += fmt::format("{:<5} {:<18} {}\n", r.claim->id, verdict_name(r.papilla.verdict),
                       r.claim->statement);
    out += fmt::format("      model: {}\n", r.papilla.model);
    if (!r.papilla.reason.empty()) out += fmt::format("      {}\n", r.papilla.reason);
    if (r.papilla.single) out += fmt::format("      {}\n", single_text(r.papilla));
    if (r.claim->both_presets) {
      out += fmt::format("      preset m3: {}, {}{}\n", verdict_name(r.m3.verdict), r.m3.model,
                         r.m3.reason.empty() ? "" : "; " + r.m3.reason);
    }
  }
  double seconds = 0;
  for (const ClaimResult& r : results) seconds += r.seconds;
  return out +
         fmt::format("{} claims: {}; {:.3g} s\n", results.size(), counts_text(results), seconds);
}

std::string claims_markdown(const std::vector<ClaimResult>& results, const std::string& finger) {
  std::string out = fmt::format(
      "# Published claims and the model\n\nWritten by `papilla reproduce --out` for the finger "
      "\"{}\".\n\n{} claims: {}. An input is a number of the finger file as it stands; an identity "
      "is a paper's formula "
      "with the paper's own numbers. Neither says anything for the model of the finger.\n\n| id | "
      "paper says | agrees when | model | verdict | reason | "
      "single patches | preset m3 |\n|---|---|---|---|---|---|---|---|\n",
      finger, results.size(), counts_text(results));
  for (const ClaimResult& r : results) {
    const std::string m3 =
        r.claim->both_presets ? verdict_name(r.m3.verdict) + ": " + r.m3.model : "";
    out += fmt::format(
        "| {} | {} ({}) | {} | {} | {} | {} | {} | {} |\n", r.claim->id,
        escaped(r.claim->statement), escaped(r.claim->source), escaped(r.claim->band),
        escaped(r.papilla.model), verdict_name(r.papilla.verdict), escaped(r.papilla.reason),
        r.papilla.single ? fmt::format("{:.0f} %", 100 * *r.papilla.single) : "", escaped(m3));
  }
  return out;
}

std::string claims_csv(const std::vector<ClaimResult>& results) {
  std::string out =
      "id,source,statement,agrees when,verdict,value,se,model,reason,single patches,m3 verdict,m3 "
      "value,m3 se,m3 model,m3 reason,m3 single patches\n";
  const auto judgement = [](const Judgement& j) {
    const std::string value = std::isfinite(j.value) ? fmt::format("{:.8g}", j.value) : "";
    const std::string se = j.se > 0 ? fmt::format("{:.3g}", j.se) : "";
    return fmt::format("{},{},{},{},{},{}", verdict_name(j.verdict), value, se, cell(j.model),
                       cell(j.reason), j.single ? fmt::format("{:.3g}", *j.single) : "");
  };
  for (const ClaimResult& r : results) {
    out += fmt::format("{},{},{},{},{},{}\n", r.claim->id, cell(r.claim->source),
                       cell(r.claim->statement), cell(r.claim->band), judgement(r.papilla),
                       r.claim->both_presets ? judgement(r.m3) : ",,,,,");
  }
  return out;
}

std::string claims_json(const std::vector<ClaimResult>& results) {
  const auto judgement = [](const Judgement& j) {
    return Json{{"model", json_number(j.value)},
                {"se", json_number(j.se)},
                {"verdict", verdict_name(j.verdict)},
                {"answer", j.model},
                {"reason", j.reason},
                {"single_patches", j.single ? json_number(*j.single) : Json()}};
  };
  Json list = Json::array();
  for (const ClaimResult& r : results) {
    Json row{{"id", r.claim->id},
             {"source", r.claim->source},
             {"paper", r.claim->statement},
             {"agrees_when", r.claim->band},
             {"basis", basis_name(r.claim->basis)}};
    row.update(judgement(r.papilla));
    if (r.claim->both_presets) row["m3"] = judgement(r.m3);
    row["seconds"] = r.seconds;
    list.push_back(row);
  }
  Json counts = Json::object();
  for (const Verdict verdict : kVerdicts) {
    counts[verdict_name(verdict)] =
        std::count_if(results.begin(), results.end(),
                      [&](const ClaimResult& r) { return r.papilla.verdict == verdict; });
  }
  return Json{{"schema", 1}, {"claims", list}, {"counts", counts}}.dump(2);
}

}  // namespace papilla::report
