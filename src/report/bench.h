// The performance targets as tables and as the page docs/performance.md.
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"
#include "measure/bench.h"

namespace papilla::report {

std::string bench_text(const std::vector<BenchRow>& rows);
std::string bench_csv(const std::vector<BenchRow>& rows, const std::string& provenance);
std::string bench_page(const std::vector<BenchRow>& rows, const std::string& provenance);
std::string bench_json(const std::vector<BenchRow>& rows);  // schema 1

}  // namespace papilla::report
