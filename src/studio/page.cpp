#include "studio/page.h"

#include <array>

#include "report/page_parts.h"

namespace papilla::studio {

// The files of src/studio/page, embedded at build time.
extern const std::string_view kStudioHtml, kStudioStyle, kStudioModule, kFormModule, kSceneModule,
    kAnswerModule, kSearchModule, kFilesModule, kLabModule, kServerModule, kTakeModule;

namespace {

struct Entry {
  const char* path;
  const char* type;
  const std::string_view* text;
};
constexpr const char* kHtml = "text/html; charset=utf-8";
constexpr const char* kCss = "text/css; charset=utf-8";
constexpr const char* kScript = "text/javascript; charset=utf-8";

const std::array kFiles{
    Entry{"/", kHtml, &kStudioHtml},
    Entry{"/page/studio.css", kCss, &kStudioStyle},
    Entry{"/page/page.css", kCss, &kPageStyle},
    Entry{"/page/studio.js", kScript, &kStudioModule},
    Entry{"/page/form.js", kScript, &kFormModule},
    Entry{"/page/scene.js", kScript, &kSceneModule},
    Entry{"/page/answer.js", kScript, &kAnswerModule},
    Entry{"/page/search.js", kScript, &kSearchModule},
    Entry{"/page/files.js", kScript, &kFilesModule},
    Entry{"/page/lab.js", kScript, &kLabModule},
    Entry{"/page/server.js", kScript, &kServerModule},
    Entry{"/page/take.js", kScript, &kTakeModule},
    Entry{"/plots/look.js", kScript, &kLookModule},
    Entry{"/plots/numbers.js", kScript, &kNumbersModule},
    Entry{"/plots/tables.js", kScript, &kTablesModule},
    Entry{"/plots/maps.js", kScript, &kMapsModule},
    Entry{"/plots/charts.js", kScript, &kChartsModule},
    Entry{"/plots/dimensions.js", kScript, &kDimensionsModule},
    Entry{"/plots/found.js", kScript, &kFoundModule},
    Entry{"/plots/parallel.js", kScript, &kParallelModule},
    Entry{"/plots/curves.js", kScript, &kCurvesModule},
    Entry{"/plots/solid.js", kScript, &kSolidModule},
    Entry{"/chart.js", kScript, &kChartScript},
    Entry{"/three.js", kScript, &kThreeScript},
};

}  // namespace

std::optional<PageFile> page_file(const std::string& path) {
  for (const Entry& entry : kFiles) {
    if (path == entry.path) return PageFile{entry.type, *entry.text};
  }
  return std::nullopt;
}

}  // namespace papilla::studio
