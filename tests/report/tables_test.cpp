// Facts of what all reports are made of.
#include "report/tables.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "base/error.h"
#include "base/files.h"
#include "fabricate/formats.h"
#include "report/json.h"
#include "report/reference.h"
#include "tests/support/refusal.h"
#include "tests/temporary.h"

namespace papilla::tests::tables_test {
namespace {

std::string written(const std::string& text) {
  const std::string path = temporary("table.csv");
  write_bytes(path, text);
  return path;
}

TEST(JsonNumbers, AreNullWhereJsonHasNone) {
  EXPECT_EQ(json_number(0.25).dump(), "0.25");
  for (double v : {std::numeric_limits<double>::infinity(), std::nan("")})
    EXPECT_TRUE(json_number(v).is_null());
  EXPECT_TRUE(json_number(std::optional<double>()).is_null());
  EXPECT_EQ(json_number(std::optional(0.5)).dump(), "0.5");
}

TEST(CsvTables, AreReadByTheNamesOfTheirColumns) {
  const CsvTable t = read_csv(written("# made here\na,b\n1,x\n# between\n2.5,\n"));
  EXPECT_EQ(t.comments, (std::vector<std::string>{"made here", "between"}));
  EXPECT_EQ(t.numbers("a"), (std::vector<double>{1, 2.5}));
  EXPECT_EQ(t.texts("b"), (std::vector<std::string>{"x", ""}));
  EXPECT_TRUE(std::isnan(t.numbers("b")[0]));
  EXPECT_FALSE(t.has("c"));
  EXPECT_THROW(t.column("c"), InputError);
}

TEST(CsvTables, WithARowOfAnotherLengthAreRefusedWithItsLine) {
  EXPECT_NE(refusal_of([&] { read_csv(written("a,b\n1,2\n3\n")); }).find(":3:1"),
            std::string::npos);
}

TEST(MarkdownTables, HaveALineBelowTheirHead) {
  EXPECT_EQ(markdown_head({"a", "b"}) + markdown_row({"1", "2"}),
            "| a | b |\n|---|---|\n| 1 | 2 |\n");
}

// One table is all that the writer, the help, the messages and the reference know.
TEST(ExportFormats, EachHasAFileOfItsOwnAndALineInTheReference) {
  const std::string reference = reference_section("export", ReferenceFormat::Markdown);
  std::set<std::string> files;
  for (const ExportFormat& format : export_format_table()) {
    EXPECT_TRUE(files.insert(format.file).second) << format.file;
    EXPECT_NE(format.write, nullptr) << format.name;
    EXPECT_NE(format.check, nullptr) << format.name;
    const std::string line = std::string("| `") + format.name + "` | `" + format.file + "`";
    EXPECT_NE(reference.find(line), std::string::npos) << line;
  }
  EXPECT_EQ(files.size(), 13u);
  EXPECT_THROW(find_export_format("bmp"), InputError);
}

TEST(ExportFormats, AreJudgedByTheMostExactFileThereIs) {
  Export result;
  result.files = {{"png", "p"}, {"tiff", "t"}, {"gsf", "g"}};
  EXPECT_EQ(heights_file(result.files), "g");
  result.files = {{"png", "p"}};
  EXPECT_THROW(heights_file(result.files), InputError);
}

}  // namespace
}  // namespace papilla::tests::tables_test
