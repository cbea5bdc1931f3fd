#include "base/digest.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>

namespace papilla::tests::digest_test {
namespace {

// FIPS 180-4 prints the first, second and last; between them the lengths around a full block.
TEST(Sha256, HasThePublishedDigests) {
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256(std::string(55, 'a')),
            "9f4390f8d30c2dd92ec9f095b65e2b9ae9b0a925a5258e241c9f1e910f734318");
  EXPECT_EQ(sha256(std::string(56, 'a')),
            "b35439a4ac6f0948b6d6f9e3c6af0f5f590ce20f1bde7090ef7970686ec6738a");
  EXPECT_EQ(sha256(std::string(64, 'a')),
            "ffe054fe7ae0cb6dc65c3af9b61d5209f439851db43d0ba5997337df154668eb");
  EXPECT_EQ(sha256(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

// The examples of RFC 1321, by pieces of any size.
TEST(Md5, HasThePublishedDigests) {
  for (const auto& [text, digest] :
       {std::pair<std::string, std::string>{"", "d41d8cd98f00b204e9800998ecf8427e"},
        {"abc", "900150983cd24fb0d6963f7d28e17f72"},
        {"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789",
         "d174ab98d277d9f5a5611c2c9f419d9f"},
        {"12345678901234567890123456789012345678901234567890123456789012345678901234567890",
         "57edf4a22be3c955ac49da2e2107b67a"}}) {
    for (const std::size_t step : {1u, 7u, 64u, 100u}) {
      Md5 md5;
      for (std::size_t at = 0; at < text.size(); at += step)
        md5.add(text.data() + at, std::min(step, text.size() - at));
      EXPECT_EQ(md5.finish(), digest) << text;
    }
  }
}

}  // namespace
}  // namespace papilla::tests::digest_test
