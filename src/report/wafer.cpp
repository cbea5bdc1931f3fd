#include "report/wafer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "base/constants.h"
#include "base/text.h"
#include "report/export.h"
#include "report/json.h"
#include "report/markup.h"
#include "report/svg.h"

namespace papilla::report {
namespace {

using Json = nlohmann::ordered_json;

Json made_json(const std::vector<WaferMade>& made) {
  Json out = Json::array();
  for (const WaferMade& m : made) {
    out.push_back({{"design", m.design},
                   {"cell", m.cell},
                   {"width", m.made.width},
                   {"wanted_width", m.made.wanted_width},
                   {"depth", m.made.depth},
                   {"wanted_depth", m.made.wanted_depth},
                   {"period", m.made.period},
                   {"wanted_period", m.made.wanted_period},
                   {"wall_angle", m.made.wall_angle},
                   {"wanted_wall_angle", m.made.wanted_wall_angle},
                   {"left", m.made.left()}});
  }
  return out;
}

// Made beside wanted: lengths as the fab measures them.
std::string made_table(const std::vector<WaferMade>& made) {
  if (made.empty()) return "";
  std::vector<std::vector<std::string>> rows{
      {"array", "width", "wanted", "depth", "wanted", "walls", "wanted", ""}};
  const auto nm = [](double v) { return fmt::format("{:.1f} nm", 1e9 * v); };
  const auto degrees = [](double v) { return fmt::format("{:.1f} deg", v * 180 / kPi); };
  for (const WaferMade& m : made) {
    rows.push_back({m.cell, nm(m.made.width), nm(m.made.wanted_width), nm(m.made.depth),
                    nm(m.made.wanted_depth), degrees(m.made.wall_angle),
                    degrees(m.made.wanted_wall_angle), m.made.as_wanted() ? "" : "differs"});
  }
  return "\n" + aligned_table(rows, 1);
}

std::string fields_table(const WaferPlan& plan) {
  std::map<std::size_t, std::string> places;
  for (const WaferField& f : plan.fields) {
    std::string& line = places[f.treatment];
    line += (line.empty() ? "" : " ") + f.id;
  }
  std::vector<std::vector<std::string>> rows;
  for (const auto& [treatment, line] : places) {
    const Treatment& t = plan.treatments[treatment];
    const bool relief = facts(t.design.texture).relief.present;
    rows.push_back({t.name, relief ? texture_name(t.design.texture) : "flat", line});
  }
  return aligned_table(rows, 3);
}

}  // namespace

std::string wafer_svg(const WaferPlan& plan) {
  constexpr std::array kColours{"#cfe3f3", "#fbdcc0", "#d5ecd0", "#f5cfcf", "#e0d5ee",
                                "#e7dcd2", "#f8d9ec", "#e2e2e2", "#eeefc5", "#c9eef2"};
  constexpr int kSide = 900;
  const WaferShape& shape = plan.list.wafer;
  const double width = std::max(shape.diameter, plan.columns * plan.pitch_x),
               height = std::max(shape.diameter, plan.rows * plan.pitch_y);
  const double scale = kSide / std::max(width, height);
  const auto px = [&](double metres) { return scale * metres; };
  const int sheet_x = static_cast<int>(std::ceil(px(width))) + 20,
            sheet_y = static_cast<int>(std::ceil(px(height))) + 20;
  std::string out = svg_sheet(sheet_x, sheet_y, 12);
  const double x0 = 0.5 * sheet_x, y0 = 0.5 * sheet_y;
  if (shape.diameter > 0) {
    out += fmt::format(
        "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\" fill=\"none\" stroke=\"#888\"/>\n", x0,
        y0, px(0.5 * shape.diameter));
  }
  for (const WaferField& f : plan.fields) {
    const double x = x0 + px(f.x - 0.5 * shape.pad_width),
                 y = y0 - px(f.y + 0.5 * shape.pad_height);
    const double w = px(shape.pad_width), h = px(shape.pad_height);
    const bool control = f.kind != FieldKind::Design;
    out += fmt::format(
        "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\" "
        "stroke=\"#555\"{}/>\n",
        x, y, w, h, f.kind == FieldKind::Flat ? "#ffffff" : kColours[f.treatment % kColours.size()],
        control ? " stroke-dasharray=\"5 3\"" : "");
    const double size = std::min(0.28 * h, 0.2 * w);
    const std::string lines[]{f.id, plan.treatments[f.treatment].name};
    for (int k = 0; k < 2; ++k) {
      out += fmt::format(
          "<text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"{:.1f}\" text-anchor=\"middle\">{}</text>\n",
          x + 0.5 * w, y + (0.42 + 0.36 * k) * h, size, markup_text(lines[k]));
    }
  }
  return out + "</svg>\n";
}

std::string wafer_text(const WaferPlan& plan, const WaferDrawing& drawing,
                       const std::vector<std::string>& files, const std::vector<WaferMade>& made) {
  std::string out;
  for (const std::string& file : files) out += file + '\n';
  out += fmt::format("\n{} fields of {:.4g} x {:.4g} mm, {} x {} at {:.4g} x {:.4g} mm\n",
                     plan.fields.size(), 1e3 * plan.list.wafer.pad_width,
                     1e3 * plan.list.wafer.pad_height, plan.columns, plan.rows, 1e3 * plan.pitch_x,
                     1e3 * plan.pitch_y);
  out += fields_table(plan) + '\n';
  for (const WaferLevel& level : drawing.levels) {
    out += level.designs.empty()
               ? fmt::format("mask {}: labels and marks alone\n", level.number)
               : fmt::format("mask {}: etch {:.6g} nm, designs {}\n", level.number,
                             1e9 * level.etch, join_names(level.designs));
  }
  for (const std::vector<std::string>* notes : {&plan.notes, &drawing.notes}) {
    for (const std::string& note : *notes) out += note + '\n';
  }
  return out + made_table(made);
}

std::string wafer_json(const WaferPlan& plan, const WaferDrawing& drawing,
                       const std::vector<std::string>& files, const std::vector<WaferMade>& made) {
  Json fields = Json::array(), levels = Json::array();
  for (const WaferField& f : plan.fields) {
    fields.push_back({{"field", f.id},
                      {"design", plan.treatments[f.treatment].name},
                      {"kind", field_kind_name(f.kind)},
                      {"repeat", f.repeat},
                      {"block", f.block},
                      {"x", f.x},
                      {"y", f.y}});
  }
  for (const WaferLevel& level : drawing.levels) {
    levels.push_back({{"layer", level.number}, {"etch", level.etch}, {"designs", level.designs}});
  }
  std::vector<std::string> notes = plan.notes;
  notes.insert(notes.end(), drawing.notes.begin(), drawing.notes.end());
  return Json{{"schema", 1},
              {"files", files},
              {"columns", plan.columns},
              {"rows", plan.rows},
              {"pitch", {plan.pitch_x, plan.pitch_y}},
              {"fields", fields},
              {"levels", levels},
              {"gradient", plan.gradient},
              {"made", made_json(made)},
              {"notes", notes}}
      .dump(2);
}

std::vector<std::string> left_lines(const std::vector<WaferMade>& made) {
  std::vector<std::string> out;
  for (const WaferMade& m : made) {
    for (const std::string& left : m.made.left()) out.push_back(m.cell + ": " + left);
  }
  return out;
}

std::string wafer_verdict_text(const WaferVerdict& verdict) {
  return verdict_text({verdict.files, std::nullopt}) + made_table(verdict.made);
}

std::string wafer_verdict_json(const std::string& folder, const WaferVerdict& verdict) {
  Json out = Json::parse(verdict_json({{folder, {verdict.files, std::nullopt}}}));
  out["made"] = made_json(verdict.made);
  if (!left_lines(verdict.made).empty()) out["sound"] = false;
  return out.dump(2);
}

}  // namespace papilla::report
