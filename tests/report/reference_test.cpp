// The reference of the keys: its sections, single keys, and what it says of names that are none.
#include "report/reference.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/files.h"
#include "report/markup.h"
#include "tests/support/refusal.h"

namespace papilla::tests::reference_test {
namespace {

std::string refusal(const std::string& section) {
  return refusal_of([&] { reference_section(section, ReferenceFormat::Text); });
}

// The pages of docs/reference/ are kept right by people who read them.
TEST(Reference, OfEachSectionIsItsPage) {
  const std::vector<std::string> sections = reference_sections();
  EXPECT_EQ(sections.size(), 17u);
  for (const std::string& section : sections) {
    EXPECT_EQ(reference_section(section, ReferenceFormat::Markdown),
              read_bytes(std::string(PAPILLA_SOURCE_DIR) + "/docs/reference/" + section + ".md"))
        << section;
  }
}

TEST(Reference, OfAKeyIsItsRowInEveryKindThatHasIt) {
  const std::string row =
      "| `search.rounding` | grid of the fab: the best design is judged again with its periods and "
      "widths on it, other lengths on finer steps; 0: not | a length in nm | 0 to 100000 nm | `10 "
      "nm` | choice |\n";
  const std::string head =
      "| key | meaning | kind | range | default | source |\n|---|---|---|---|---|---|\n";
  EXPECT_EQ(reference_section("search.rounding", ReferenceFormat::Markdown), head + row);
  // Of a texture each kind that has a wall angle, in the order of the kinds, and no other.
  const std::string walls = reference_section("texture.wall_angle", ReferenceFormat::Markdown);
  const std::string page = reference_section("texture", ReferenceFormat::Markdown);
  std::string expected, heading;
  for (std::size_t at = 0, end = 0; at < page.size(); at = end + 1) {
    end = page.find('\n', at);
    const std::string line = page.substr(at, end - at + 1);
    if (line.starts_with("## ")) heading = "\n" + line + "\n" + head;
    if (line.starts_with("| `texture.wall_angle` ")) expected += heading + line;
  }
  EXPECT_EQ(walls, expected);
  EXPECT_GE(expected.size(), 3 * head.size());
  // A section of a section has all its keys, but none that only begins like it.
  const std::string rubbing = reference_section("finger.macro", ReferenceFormat::Text);
  EXPECT_EQ(rubbing.find("[finger.macro]"), 1u) << rubbing;
  EXPECT_NE(rubbing.find("finger.macro.shear_strength"), std::string::npos);
  EXPECT_EQ(rubbing.find("finger.load "), std::string::npos);
  EXPECT_NE(refusal("finger.macr"), "");
}

TEST(Reference, OfASectionOfStudiesHasItsKeysAlone) {
  EXPECT_EQ(reference_section("base", ReferenceFormat::Markdown),
            "# base\n\nAnother file below this one.\n\n| key | meaning |\n|---|---|\n| `base` | "
            "another file that lies below this one; found beside it, then in the designs folder "
            "|\n");
  EXPECT_EQ(reference_section("population", ReferenceFormat::Text),
            "population: The fingers that a design is judged on.\n\n"
            "population.fingers                   finger files; load, state, touch_time and belief "
            "hold for all where the study itself says them in [finger] (not by the file that "
            "[finger] is based on)\n"
            "population.shared                    which of these hold for all, as a resolved file "
            "names them: [\"load\", \"state\"]\n");
  const std::string scatter = reference_section("scatter", ReferenceFormat::Text);
  EXPECT_EQ(scatter,
            "scatter: How far fabrication may miss.\n\n"
            "scatter.\"PATH\"                       fabrication misses this number by up to so "
            "much either way; two more evaluations each\n"
            "scatter.\"PATH\" = { sigma = ... }     the same, normal with this standard deviation\n"
            "scatter.correlation                  of two of them: [{ between = [\"PATH\", "
            "\"PATH\"], value = 0.6 }]; the others are independent\n");
  EXPECT_TRUE(reference_section("scenarios", ReferenceFormat::Text)
                  .starts_with("scenarios: States of the product that count beside each other.\n\n"
                               "scenarios  "));
  for (const auto& [section, keys] :
       {std::pair("design_space", 5), {"objective", 3}, {"constraints", 16}, {"search", 7}}) {
    const std::string text = reference_section(section, ReferenceFormat::Markdown);
    int count = 0;
    const std::string mark = std::string("\n| `") + section + ".";
    for (std::size_t at = 0; (at = text.find(mark, at)) != std::string::npos; ++at) ++count;
    EXPECT_EQ(count, keys) << text;
    EXPECT_EQ(text.find("## "), std::string::npos) << section;  // one table, no heading
    int rows = 0;
    for (std::size_t at = 0; (at = text.find("\n| `", at)) != std::string::npos; ++at) ++rows;
    EXPECT_EQ(rows, keys) << section;
  }
}

TEST(Reference, ForPeopleATableHasItsHeadingAndNoRules) {
  const std::string study = reference_section("study", ReferenceFormat::Text);
  EXPECT_TRUE(study.starts_with("study: The sections that only a study has.\n\nbase   ")) << study;
  EXPECT_NE(study.find("\n\nsearch\nsearch.method  "), std::string::npos) << study;
  EXPECT_EQ(study.find('|'), std::string::npos);
  EXPECT_NE(
      study.find("constraints.min_hole                 smallest hole or gap between features, at "
                 "its floor; of gradual profiles at half the depth"),
      std::string::npos);
  EXPECT_NE(
      study.find("constraints.aspect_ratio             largest depth / smallest hole or wall"),
      std::string::npos);
}

TEST(Reference, ForProgramsAPlainTableHasMeaningsAlone) {
  const auto json = nlohmann::json::parse(reference_json({"export", "search.time", "texture"}));
  EXPECT_EQ(json["schema"], 1);
  ASSERT_EQ(json["sections"].size(), 3u);
  const auto& plain = json["sections"][0];
  EXPECT_EQ(plain["section"], "export");
  EXPECT_EQ(plain["about"],
            "The files of `papilla export`, by the names that `--format` takes. Without it: those "
            "that need nothing that is missing.");
  EXPECT_EQ(plain["tables"][0]["name"], "");
  EXPECT_EQ(plain["tables"][0]["keys"].size(), 13u);
  EXPECT_EQ(plain["tables"][0]["keys"][1],
            (nlohmann::json{{"key", "tiff"},
                            {"meaning",
                             "`heightmap.tif`: heights in 16 bits between the lowest and the "
                             "highest; needs a polarity (`--polarity`)"}}));
  const auto& key = json["sections"][1];
  EXPECT_EQ(key["section"], "search.time");
  EXPECT_EQ(key["about"], "");
  EXPECT_EQ(key["tables"],
            nlohmann::json::array({{{"name", ""},
                                    {"keys",
                                     {{{"key", "search.time"},
                                       {"meaning", "largest wall-clock time; 0: no limit"},
                                       {"kind", "a time in min"},
                                       {"range", "0 to 1000000 min"},
                                       {"default", "0 min"},
                                       {"source", "choice"},
                                       {"reference", ""},
                                       {"required", false}}}}}}))
      << key.dump(1);
  EXPECT_EQ(json["sections"][2]["tables"][1]["name"], "hole_array");
}

TEST(Reference, AWordOfTheFieldLeadsToItsKey) {
  EXPECT_EQ(refusal("textur"), "no section `textur`, did you mean `texture`?");
  EXPECT_EQ(refusal("voltage"), "no section `voltage`, did you mean `drive.amplitude`?");
  EXPECT_EQ(refusal("wall_angle"), "no section `wall_angle`, did you mean `texture.wall_angle`?");
  EXPECT_EQ(refusal("scater"), "no section `scater`, did you mean `scatter`?");
  EXPECT_EQ(
      refusal("qqqqqqqqqqqq"),
      "no section `qqqqqqqqqqqq`; known: texture, surface, view, finger, counterface, "
      "environment, drive, model, accuracy, study, metrics, persson, circuit, statistics, "
      "export, wafer, calibration, design_space, objective, constraints, population, scenarios, "
      "scatter, risk, search, base");
  EXPECT_EQ(refusal("texture.depht"), "no key `texture.depht`, did you mean `texture.depth`?");
  // A word of its own section before others: the surface is stiff, and so is the skin.
  EXPECT_EQ(refusal("surface.stiffness"),
            "no key `surface.stiffness`, did you mean `surface.modulus`?");
  EXPECT_EQ(refusal("finger.stiffness"),
            "no key `finger.stiffness`, did you mean `finger.skin.layer_modulus`?");
  EXPECT_EQ(refusal("view.qqqqqqqqqqqqqqqqq"),
            "no key `view.qqqqqqqqqqqqqqqqq`; `papilla describe view` lists them");
}

TEST(Markup, TakesWhatWouldEndOrBeginAnElement) {
  EXPECT_EQ(markup_text("a<b & c>d"), "a&lt;b &amp; c>d");
  EXPECT_EQ(script_text("</script><!--"), "\\u003c/script>\\u003c!--");
  EXPECT_EQ(script_text("a < b"), "a \\u003c b");
  EXPECT_EQ(script_text(""), "");
  EXPECT_EQ(nlohmann::json::parse(script_text("{\"a\": \"<<b<\"}"))["a"], "<<b<");
}

TEST(Markup, OfMarkdownHasItsHeadingsParagraphsAndTables) {
  EXPECT_EQ(markdown_html("# A title\n\nWith **bold** and `code` < 3\n\n## What & why\n"
                          "| a | b<c |\n|---|---|\n| 1 | **2** |\n| 3 |  |\nAfter it\n"
                          "| x |\n|---|"),
            "<p>With bold and code &lt; 3</p>\n<h2>What &amp; why</h2>\n"
            "<div class=\"scroll\"><table>\n<tr><th>a</th><th>b&lt;c</th></tr>\n"
            "<tr><td>1</td><td>2</td></tr>\n<tr><td>3</td><td></td></tr>\n</table></div>\n"
            "<p>After it</p>\n<div class=\"scroll\"><table>\n<tr><th>x</th></tr>\n"
            "</table></div>\n");
  EXPECT_EQ(markdown_html("| a |\n"),
            "<div class=\"scroll\"><table>\n<tr><th>a</th></tr>\n"
            "</table></div>\n");
  EXPECT_EQ(markdown_html(""), "");
}

}  // namespace
}  // namespace papilla::tests::reference_test
