#include "tests/support/golden.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "base/files.h"
#include "base/rooms.h"

namespace papilla::tests {

testing::AssertionResult is_golden(const std::string& text, const std::string& name) {
  const std::filesystem::path file = std::filesystem::path(PAPILLA_SOURCE_DIR) / "tests" / name;
  if (std::getenv("PAPILLA_UPDATE_GOLDEN") != nullptr) {
    std::filesystem::create_directories(file.parent_path());
    write_bytes(file, text);
    return testing::AssertionSuccess();
  }
  if (!std::filesystem::exists(file))
    return testing::AssertionFailure() << file << " is missing: PAPILLA_UPDATE_GOLDEN=1 writes it";
  const std::string golden = read_bytes(file);
  if (text == golden) return testing::AssertionSuccess();
  const auto same = std::mismatch(text.begin(), text.end(), golden.begin(), golden.end()).first;
  const auto at = static_cast<std::size_t>(same - text.begin());
  const auto around = [at](const std::string& all) {
    const std::size_t from = at < 60 ? 0 : at - 60;
    return all.substr(from, 160);
  };
  return testing::AssertionFailure() << fmt::format(
             "{} differs from byte {} (line {}) on:\n  golden ...{}...\n  now    ...{}...", name,
             at, 1 + std::count(text.begin(), same, '\n'), around(golden), around(text));
}

}  // namespace papilla::tests
