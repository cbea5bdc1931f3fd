// X3P as another language reads it: a zip whose sums hold, heights with the top row first.
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <sstream>
#include <string>

#include "geometry/io/layout.h"
#include "tests/temporary.h"

namespace papilla::tests {
namespace {

constexpr const char* kReader = R"(
import hashlib, re, struct, sys, zipfile
archive = zipfile.ZipFile(sys.argv[1])
assert archive.testzip() is None
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

}  // namespace
}  // namespace papilla::tests
