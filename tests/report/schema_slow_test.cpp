// The JSON Schema against the files that the reader takes, by a validator of its own.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "report/schema.h"
#include "tests/cli/program.h"

namespace papilla::tests::schema_slow_test {
namespace {

TEST(JsonSchema, AcceptsEveryDesignAndRefusesTwoHundredMutants) {
  const Workplace place;
  if (place.shell("python3 -c 'import jsonschema, tomllib'").status)
    GTEST_SKIP() << "needs python3-jsonschema (scripts/setup --test)";
  ASSERT_EQ(place.shell("'" PAPILLA_PROGRAM "' describe --json-schema > schema.json").status, 0);
  const Outcome run =
      place.shell("python3 " PAPILLA_SOURCE_DIR
                  "/tests/report/schema.py schema.json " PAPILLA_DESIGNS_DIR " 24 200");
  EXPECT_EQ(run.status, 0) << run.out << run.err;
  EXPECT_NE(run.out.find("200 mutants, 0 mistakes"), std::string::npos) << run.out;
}

TEST(JsonSchema, TellsEditorsWhatAKeyMeans) {
  const auto schema = nlohmann::json::parse(json_schema());
  const auto& time = schema["properties"]["search"]["properties"]["time"];
  EXPECT_NE(time["description"].get<std::string>().find("wall-clock"), std::string::npos);
  EXPECT_NE(time["pattern"].get<std::string>().find("min"), std::string::npos);
}

}  // namespace
}  // namespace papilla::tests::schema_slow_test
