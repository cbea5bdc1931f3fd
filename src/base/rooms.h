// The rooms of the house as namespaces, lowest first: each sees the rooms that it names and all
// that they see, and no other. tests/architecture checks the includes against this list.
#pragma once

namespace papilla {

namespace base {}
namespace numerics {
using namespace base;
}
namespace config {
using namespace numerics;
}
namespace optim {
using namespace numerics;
}
namespace geometry {
using namespace config;
}
namespace scene {
using namespace config;
}
namespace maps {
using namespace geometry;
}
// Pieces of physics never see each other; forward::coupling joins them.
namespace contact {
using namespace scene;
using namespace maps;
}  // namespace contact
namespace capillary {
using namespace scene;
using namespace maps;
}  // namespace capillary
namespace electrostatics {
using namespace scene;
using namespace maps;
}  // namespace electrostatics
namespace optics {
using namespace scene;
using namespace maps;
}  // namespace optics
namespace macro {
using namespace scene;
using namespace maps;
}  // namespace macro
namespace drive {
using namespace scene;
using namespace maps;
}  // namespace drive
namespace persson {
using namespace scene;
using namespace maps;
}  // namespace persson
namespace forward {
using namespace contact;
using namespace capillary;
using namespace electrostatics;
using namespace optics;
using namespace macro;
using namespace drive;
using namespace persson;
}  // namespace forward
namespace metrics {
using namespace forward;
}
namespace design {
using namespace metrics;
using namespace optim;
}  // namespace design
namespace estimate {
using namespace design;
}
namespace published {
using namespace estimate;
}
// Side by side, but the lab: it stands on the search, whose decisions it settles.
namespace search {
using namespace published;
}
namespace rank {
using namespace published;
}
namespace calibrate {
using namespace published;
}
namespace claims {
using namespace published;
}
namespace measure {
using namespace published;
}
namespace fabricate {
using namespace published;
}
namespace cases {
using namespace published;
}
namespace lab {
using namespace search;
}
namespace report {
using namespace lab;
using namespace rank;
using namespace calibrate;
using namespace claims;
using namespace measure;
using namespace fabricate;
using namespace cases;
}  // namespace report
// All of them but the page, for those who stand above: the program, the library's public face, the
// tests.
namespace rooms {
using namespace report;
}
namespace studio {
using namespace rooms;
}
namespace cli {
using namespace studio;
}
namespace tests {
using namespace cli;
}

}  // namespace papilla
