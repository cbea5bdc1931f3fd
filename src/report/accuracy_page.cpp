// The page docs/measured/accuracy.md from the committed tables.
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

#include "report/accuracy.h"
#include "report/tables.h"

namespace papilla::report {
namespace {

std::string shown(const std::string& cell, double scale, const char* format) {
  const double v = std::strtod(cell.c_str(), nullptr);
  return cell.empty() ? "–" : fmt::format(fmt::runtime(format), scale * v);
}

const char* sweep_text(const std::string& sweep) {
  if (sweep == "grid")
    return "Pixels along the patch; same skins and droplets; error against the finest";
  if (sweep == "skins") return "Number of skins; error against the most";
  if (sweep == "seed")
    return "Other skins, offsets and droplets; error against the mean of the seeds";
  if (sweep == "tolerance") return "Certificate of the contact solver; error against the tightest";
  if (sweep == "field")
    return "Residual of the potential that spreads in the dielectric; error against the smallest";
  if (sweep == "estimator") return "Load law or solved areas; error against the latter";
  if (sweep == "model")
    return "Options of `[model]`; shift against the file's own (absorbed by the fit of the finger)";
  if (sweep == "level") return "Levels; error against reference";
  if (sweep == "cost")
    return "Pixels and skins together, and levels: root-mean-square error over four seeds against "
           "the level reference. The lines of the picture join the settings that no cheaper one "
           "beats";
  return "";
}

// A row of sweeps.csv by the names of its columns.
class SweepRow {
 public:
  SweepRow(const CsvTable& table, const std::vector<std::string>& cells)
      : table_(table), cells_(cells) {}

  const std::string& cell(const std::string& name) const { return cells_[table_.column(name)]; }
  double number(const std::string& name) const { return std::strtod(cell(name).c_str(), nullptr); }

  // "+1.20 % (0.8 %)": error, and the standard error stated beside it.
  std::string error(const std::string& quantity) const {
    const double value = std::abs(number(quantity));
    return shown(cell(quantity + "_error"), 100, "{:+.2f} %") + " (" +
           shown(cell(quantity + "_stated"), value != 0 ? 100 / value : 0, "{:.1f} %") + ")";
  }
  // "4 skins, friction (2.3)" where the error is beyond two standard errors stated; else empty.
  std::string beyond(const std::string& quantity) const {
    const double value = std::abs(number(quantity)), stated = number(quantity + "_stated"),
                 error = number(quantity + "_error");
    const double off = std::abs(error / (1 + error)) * value;  // value less truth
    if (!(off > 2 * stated)) return {};
    return fmt::format("{}, {} ({:.1f})", cell("setting"), quantity, off / stated);
  }

  std::string markdown() const {
    std::vector<std::string> out{cell("setting")};
    for (const AccuracyQuantity& q : accuracy_quantities()) out.push_back(error(q.name));
    out.push_back(shown(cell("modulation"), 1, "{:.4f}"));
    for (const char* name : {"fft_pairs", "work", "processor_seconds", "status"})
      out.push_back(cell(name));
    return markdown_row(out);
  }

 private:
  const CsvTable& table_;
  const std::vector<std::string>& cells_;
};

std::string sweep_head(const std::string& sweep) {
  std::vector<std::string> names{"setting"};
  for (const AccuracyQuantity& q : accuracy_quantities()) names.push_back(q.name);
  for (const char* name :
       {"mean modulation", "FFT pairs", "work, pairs of 256²", "processor seconds", "status"})
    names.emplace_back(name);
  return fmt::format(
             "\n## {0}\n\n{1}. Error of the value, in brackets the standard error stated "
             "beside it.\n\n![{0}](../../results/accuracy/{0}.svg)\n\n",
             sweep, sweep_text(sweep)) +
         markdown_head(names);
}

// The rows of each sweep follow each other in the table.
std::string sweep_sections(const CsvTable& sweeps) {
  std::string out, current, beyond;  // of the sweep: what its rows state too little for
  const auto end_sweep = [&] {
    // The options of the model have shifts, no errors; a root mean square has no sign.
    if (current.empty() || current == "model" || current == "cost") return;
    out +=
        "\nBeyond two of the standard errors stated: " + (beyond.empty() ? "none" : beyond) + ".\n";
  };
  for (const auto& cells : sweeps.rows) {
    const SweepRow row(sweeps, cells);
    if (row.cell("sweep") != current) {
      end_sweep();
      beyond.clear();
      current = row.cell("sweep");
      out += sweep_head(current);
    }
    out += row.markdown();
    for (const AccuracyQuantity& q : accuracy_quantities()) {
      if (const std::string text = row.beyond(q.name); !text.empty())
        beyond += (beyond.empty() ? "" : "; ") + text;
    }
  }
  end_sweep();
  return out;
}

std::string comment_list(const CsvTable& table) {
  std::string out;
  for (const std::string& line : table.comments) out += "- " + line + "\n";
  return out;
}

std::string coverage_section(const std::string& folder) {
  std::string out = "\n## Error bars on held-out scenes\n\n";
  std::vector<CoverageSummary> rows;
  for (const char* name : {"/coverage.csv", "/coverage_tight.csv"}) {
    out += comment_list(read_csv(folder + name));
    const auto more = coverage_summary(read_coverage(folder + name));
    rows.insert(rows.end(), more.begin(), more.end());
  }
  out +=
      '\n' + markdown_head({"fidelity", "quantity", "scenes", "reference inside the 95 % interval",
                            "with the reference's own error", "median half-width",
                            "95 % quantile of the error", "ratio",
                            "error over stated standard error, rms"});
  for (const CoverageSummary& s : rows) {
    out += fmt::format(
        "| {} | {} | {} | {:.0f} % | {:.0f} % | {:.4g} | {:.4g} | {:.2f} | {:.2f} |\n", s.fidelity,
        s.quantity, s.scenes, 100 * s.inside, 100 * s.inside_both, s.median_half_width,
        s.error_quantile, s.median_half_width / s.error_quantile, s.rms_ratio);
  }
  return out;
}

}  // namespace

std::string accuracy_page(const std::string& folder) {
  const CsvTable sweeps = read_csv(folder + "/sweeps.csv");
  return "# Speed against error\n\nMade by `papilla accuracy --render results/accuracy` from the "
         "tables there. What the parts of an error are: docs/theory/accuracy.md.\n\n" +
         comment_list(sweeps) + sweep_sections(sweeps) + coverage_section(folder);
}

}  // namespace papilla::report
