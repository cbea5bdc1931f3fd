// X3P as another language reads it: a zip whose sums hold, heights with the top row first.
#include <gtest/gtest.h>

#include <cctype>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/files.h"
#include "geometry/io/height_rows.h"
#include "geometry/io/layout.h"
#include "geometry/io/raw.h"
#include "tests/io/zip_file.h"
#include "tests/support/refusal.h"
#include "tests/temporary.h"

namespace papilla::tests::x3p_test {
namespace {

constexpr const char* kReader = R"(
import hashlib, re, struct, sys, zipfile
archive = zipfile.ZipFile(sys.argv[1])
assert archive.testzip() is None
assert archive.namelist() == ["main.xml", "bindata/data.bin", "md5checksum.hex"]
for entry in archive.infolist():
    assert entry.date_time == (2000, 1, 1, 0, 0, 0) and entry.extract_version == 20
    assert entry.create_version == 20 and entry.compress_type == 0
    assert not (entry.flag_bits or entry.volume or entry.internal_attr or entry.external_attr)
    assert not (entry.extra or entry.comment)
assert open(sys.argv[1], "rb").read()[-18:-14] == bytes(4) and archive.comment == b""
xml, data = archive.read("main.xml"), archive.read("bindata/data.bin")
assert archive.read("md5checksum.hex").split()[0].decode() == hashlib.md5(xml).hexdigest()
text = xml.decode()
def inside(name): return re.search("<%s>(.*?)</%s>" % (name, name), text)[1]
assert inside("MD5ChecksumPointData") == hashlib.md5(data).hexdigest()
nx, ny = int(inside("SizeX")), int(inside("SizeY"))
steps = [float(s) for s in re.findall("<Increment>(.*?)</Increment>", text)]
print(nx, ny, *["%.17g" % s for s in steps])
print(*["%.17g" % v for v in struct.unpack("<%dd" % (nx * ny), data)])
)";

TEST(X3p, IsReadByAnotherLanguageWithAllItsSums) {
  if (std::system("command -v python3 > /dev/null") != 0) GTEST_SKIP() << "needs python3";
  const std::string folder = temporary("");
  std::ofstream(folder + "papilla_x3p.py") << kReader;
  for (const int nx : {3, 7, 50}) {  // below a block of the sum, across its end, several
    const Grid grid{nx, 4, 6e-6, 2e-6};
    Heightmap h{grid, std::vector<double>(grid.size())};
    for (std::size_t i = 0; i < h.z.size(); ++i) h.z[i] = -1e-9 * static_cast<double>(i) / 3;
    const std::string path = folder + "papilla_heights.x3p", out = folder + "papilla_x3p.txt";
    write_x3p(path, h);
    ASSERT_EQ(std::system(("python3 " + folder + "papilla_x3p.py " + path + " > " + out).c_str()),
              0);
    std::ifstream in(out);
    int columns = 0, rows = 0;
    double dx = 0, dy = 0, dz = 0;
    in >> columns >> rows >> dx >> dy >> dz;
    EXPECT_EQ(columns, nx);
    EXPECT_EQ(rows, 4);
    EXPECT_EQ(dx, grid.dx());
    EXPECT_EQ(dy, grid.dy());
    EXPECT_EQ(dz, 1);
    for (int iy = 3; iy >= 0; --iy) {
      for (int ix = 0; ix < nx; ++ix) {
        double z = 1;
        in >> z;
        ASSERT_EQ(z, h(ix, iy)) << ix << " " << iy;
      }
    }
  }
}

Heightmap oblong() {
  const Grid grid{7, 4, 6e-6, 2e-6};
  Heightmap h{grid, std::vector<double>(grid.size())};
  for (std::size_t i = 0; i < h.z.size(); ++i) h.z[i] = -1e-9 * static_cast<double>(i * i) / 3;
  return h;
}

// What reading every row of the file says; "" where all of it is sound.
std::string refusal(const std::string& path, Heightmap* read = nullptr) {
  return refusal_of([&] {
    const auto rows = open_height_rows(path);
    Heightmap h = whole_map(*rows, 0);
    if (read) *read = h;
  });
}

TEST(X3p, IsReadBackToTheLastBit) {
  const Heightmap h = oblong();
  const std::string path = temporary("own.x3p");
  write_x3p(path, h);
  Heightmap back;
  ASSERT_EQ(refusal(path, &back), "");
  EXPECT_EQ(back.z, h.z);
  EXPECT_EQ(back.grid.nx, 7);
  EXPECT_NEAR(back.grid.lx, 6e-6, 1e-18);
  EXPECT_NEAR(back.grid.ly, 2e-6, 1e-18);
}

TEST(X3p, AChangedBitAndACutEndAreNoticed) {
  const std::string path = temporary("own.x3p"), wrong = temporary("wrong.x3p");
  write_x3p(path, oblong());
  const std::string bytes = read_bytes(path);
  const std::size_t xml = bytes.find("<?xml"), end = bytes.find("</p:ISO5436_2>"),
                    name = bytes.find("bindata/data.bin", end), data = name + 16;
  ASSERT_NE(name, std::string::npos);
  const auto reading = [&](const std::string& other) {
    std::ofstream(wrong, std::ios::binary) << other;
    return refusal(wrong);
  };
  const auto changed = [&](std::size_t at) {
    std::string other = bytes;
    other[at] = static_cast<char>(other[at] ^ 4);
    return reading(other);
  };
  for (std::size_t at = xml; at < end; at += 5) ASSERT_NE(changed(at), "") << at;
  for (std::size_t at = data; at < data + 28 * 8; at += 3) {
    const std::string why = changed(at);
    ASSERT_NE(why.find("the sum of its heights is another"), std::string::npos) << at << why;
  }
  for (std::size_t length = 0; length < bytes.size(); length += length < 80 ? 1 : 17) {
    ASSERT_NE(reading(bytes.substr(0, length)), "") << length;
  }
}

// As other programs write it: compressed, its entries in another order and under other names,
// digits of sums as capitals.
std::vector<ZipEntry> entries_of_others(const Heightmap& h) {
  const std::string path = temporary("plain.x3p");
  write_x3p(path, h);
  auto [xml, heights] = x3p_parts(path, h.z.size());
  const auto exchange = [&](const std::string& from, const std::string& to) {
    xml.replace(xml.find(from), from.size(), to);
  };
  std::string capitals = md5_of(heights);
  for (char& c : capitals) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  exchange(md5_of(heights), capitals);
  exchange("bindata/data.bin", "data/z.bin");
  return {{"md5checksum.hex", md5_of(xml) + " *main.xml\n"},
          {"data/z.bin", heights},
          {"main.xml", xml}};
}

TEST(X3p, ReadsCompressedFilesOfOthersToTheLastBit) {
  const Heightmap h = oblong();
  const std::string path = temporary("packed.x3p");
  for (const int method : {ZIP_CM_DEFLATE, ZIP_CM_STORE}) {
    write_zip(path, entries_of_others(h), method);
    Heightmap back;
    ASSERT_EQ(refusal(path, &back), "");
    EXPECT_EQ(back.z, h.z);
    EXPECT_NEAR(back.grid.lx, 6e-6, 1e-18);
    EXPECT_NEAR(back.grid.ly, 2e-6, 1e-18);
  }
}

// Its rows or columns stand in the other order; its sides are what they are.
TEST(X3p, AnAxisThatRunsBackwardsIsTurnedRound) {
  const Heightmap h = oblong();
  const std::string path = temporary("backwards.x3p");
  for (const bool along_x : {true, false}) {
    std::vector<ZipEntry> entries = entries_of_others(h);
    std::string& xml = entries[2].bytes;
    xml.insert(xml.find("<Increment>", xml.find(along_x ? "<CX>" : "<CY>")) + 11, "-");
    entries[0].bytes = md5_of(xml) + " *main.xml\n";
    write_zip(path, entries);
    Heightmap back;
    ASSERT_EQ(refusal(path, &back), "");
    EXPECT_NEAR(back.grid.lx, 6e-6, 1e-18);
    EXPECT_NEAR(back.grid.ly, 2e-6, 1e-18);
    for (int iy = 0; iy < 4; ++iy) {
      for (int ix = 0; ix < 7; ++ix)
        ASSERT_EQ(back(ix, iy), along_x ? h(6 - ix, iy) : h(ix, 3 - iy)) << ix << " " << iy;
    }
  }
}

TEST(X3p, RefusesDamagedCompressedFiles) {
  const std::string path = temporary("packed.x3p"), wrong = temporary("wrong.x3p");
  write_zip(path, entries_of_others(oblong()));
  const std::string bytes = read_bytes(path);
  for (std::size_t length = 0; length < bytes.size(); length += 7) {
    write_bytes(wrong, bytes.substr(0, length));
    ASSERT_NE(refusal(wrong), "") << length;
  }
  // Another bit in the packed heights: of deflate, of a sum, or of the heights.
  const std::size_t begin = bytes.find("data/z.bin") + 10, end = bytes.find("PK", begin);
  for (std::size_t at = begin; at < end; ++at) {
    std::string other = bytes;
    other[at] = static_cast<char>(other[at] ^ 4);
    write_bytes(wrong, other);
    ASSERT_NE(refusal(wrong), "") << at;
  }
}

TEST(X3p, UnpacksNoMoreThanItsPixels) {
  const std::string path = temporary("bomb.x3p");
  const std::vector<ZipEntry> sound = entries_of_others(oblong());
  std::vector<ZipEntry> entries = sound;
  entries[2].bytes.append(2 << 20, ' ');
  write_zip(path, entries);
  EXPECT_EQ(refusal(path), "cannot read " + path + ": main.xml in it has more than 1048576 bytes");

  entries = sound;
  entries[1].bytes.append(64 << 20, '\0');
  write_zip(path, entries);
  ASSERT_LT(read_bytes(path).size(), 100u << 10);
  EXPECT_EQ(refusal(path), "cannot read " + path + ": not as many heights as pixels are due");

  // Declared as small as it should be, in both directories of the zip.
  std::string bytes = read_bytes(path);
  const std::string declared = little(entries[1].bytes.size(), 4), due = little(28 * 8, 4);
  for (std::size_t at = 0; (at = bytes.find(declared, at)) != std::string::npos; at += 4)
    bytes.replace(at, 4, due);
  write_bytes(path, bytes);
  EXPECT_NE(refusal(path), "");

  entries = sound;
  entries.erase(entries.begin());
  write_zip(path, entries);
  EXPECT_EQ(refusal(path), "cannot read " + path + ": a zip without md5checksum.hex");
  write_bytes(path, "no zip at all");
  EXPECT_EQ(refusal(path),
            "cannot read " + path + ": it does not open as a zip: Not a zip archive");
}

}  // namespace
}  // namespace papilla::tests::x3p_test
