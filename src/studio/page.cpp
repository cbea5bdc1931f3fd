#include "studio/page.h"

#include <array>

#include "report/page_parts.h"

namespace papilla::studio {

// The files of src/studio/page, embedded at build time.
extern const std::string_view kStudioHtml, kStudioStyle, kStudioModule, kFormModule, kSceneModule,
    kAnswerModule, kSearchModule, kFilesModule, kLabModule, kServerModule, kTakeModule, kSvgModule,
    kWordsModule;

namespace {

struct Served {
  const char* path;
  const char* type;
  const std::string_view* text;
};
constexpr const char* kHtml = "text/html; charset=utf-8";
constexpr const char* kCss = "text/css; charset=utf-8";
constexpr const char* kScript = "text/javascript; charset=utf-8";

const std::array kFiles{
    Served{"/", kHtml, &kStudioHtml},
    Served{"/page/studio.css", kCss, &kStudioStyle},
    Served{"/page/page.css", kCss, &kPageStyle},
    Served{"/page/studio.js", kScript, &kStudioModule},
    Served{"/page/form.js", kScript, &kFormModule},
    Served{"/page/scene.js", kScript, &kSceneModule},
    Served{"/page/answer.js", kScript, &kAnswerModule},
    Served{"/page/search.js", kScript, &kSearchModule},
    Served{"/page/files.js", kScript, &kFilesModule},
    Served{"/page/lab.js", kScript, &kLabModule},
    Served{"/page/server.js", kScript, &kServerModule},
    Served{"/page/take.js", kScript, &kTakeModule},
    Served{"/page/svg.js", kScript, &kSvgModule},
    Served{"/page/words.js", kScript, &kWordsModule},
    Served{"/plots/look.js", kScript, &kLookModule},
    Served{"/plots/numbers.js", kScript, &kNumbersModule},
    Served{"/plots/tables.js", kScript, &kTablesModule},
    Served{"/plots/maps.js", kScript, &kMapsModule},
    Served{"/plots/charts.js", kScript, &kChartsModule},
    Served{"/plots/dimensions.js", kScript, &kDimensionsModule},
    Served{"/plots/found.js", kScript, &kFoundModule},
    Served{"/plots/parallel.js", kScript, &kParallelModule},
    Served{"/plots/curves.js", kScript, &kCurvesModule},
    Served{"/plots/solid.js", kScript, &kSolidModule},
    Served{"/chart.js", kScript, &kChartScript},
    Served{"/three.js", kScript, &kThreeScript},
};

}  // namespace

std::optional<PageFile> page_file(const std::string& path) {
  for (const Served& file : kFiles) {
    if (path == file.path) return PageFile{file.type, *file.text};
  }
  return std::nullopt;
}

}  // namespace papilla::studio
