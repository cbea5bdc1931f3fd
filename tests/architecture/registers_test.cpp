// One room knows how wide a register is; loops elsewhere are written once for any number of pixels
// (src/numerics/loops.h).
#include <gtest/gtest.h>

#include <regex>

#include "tests/architecture/source_tree.h"

namespace papilla::tests::registers_test {
namespace {

const std::regex& register_words() {
  static const std::regex pattern(
      "omp simd|vector_size|__m(128|256|512)|_mm(256|512)?_\\w+|\\w*mmintrin\\.h|immintrin|"
      "experimental/simd|__builtin_(shuffle|convertvector|ia32)\\w*|\\bkLanes\\b|\\bkSize\\b|"
      "\\bkRegisterBytes\\b|\\b(numerics::)?Vector<\\s*(double|float|int)\\b|target_clones");
  return pattern;
}

// What names a register there. Each alternative of the pattern needs one of the words.
std::vector<std::string> named_in(const std::string& text) {
  std::vector<std::string> out;
  for (const std::string& s :
       statements_with(text, {{"simd", "vector_size", "__m", "_mm", "mmintrin", "__builtin_",
                               "kLanes", "kSize", "kRegisterBytes", "Vector<", "target_clones"}})) {
    for (std::sregex_iterator it(s.begin(), s.end(), register_words()), end; it != end; ++it)
      out.push_back(it->str());
  }
  return out;
}

TEST(Registers, AreKnownToNumericsAlone) {
  int files = 0;
  for (const std::string& file : source_files({"src", "optim", "geometry"}, {".h", ".cpp"})) {
    if (file.starts_with("src/numerics/")) continue;
    const std::string text = read_source(std::string(PAPILLA_SOURCE_DIR) + "/" + file);
    for (const std::string& named : named_in(text))
      ADD_FAILURE() << file << " names a register: " << named;
    ++files;
  }
  EXPECT_GT(files, 300);
}

TEST(Registers, TheRuleSeesWhatItShould) {
  for (const char* wrong :
       {"#pragma omp simd reduction(+ : sum)", "double __attribute__((vector_size(32)))",
        "__m256d v", "__m512 v", "#include <immintrin.h>", "_mm512_add_pd(a, b)",
        "#include <experimental/simd>", "for (i = 0; i < n; i += kLanes)",
        "__builtin_shufflevector(a, b, 0, 4)", "using Eight = Vector<double>;"}) {
    EXPECT_FALSE(named_in(wrong).empty()) << wrong;
  }
  for (const char* right :
       {"#pragma omp parallel for schedule(dynamic, 1)", "for_each_pixel(n, [&](auto at) {})",
        "std::vector<double> sums", "planes"}) {
    EXPECT_TRUE(named_in(right).empty()) << right;
  }
}

}  // namespace
}  // namespace papilla::tests::registers_test
