// The performance targets as tables and as the page docs/measured/performance.md.
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"
#include "measure/bench.h"
#include "measure/prices.h"

namespace papilla::report {

std::string bench_text(const std::vector<BenchRow>& rows);
std::string bench_csv(const std::vector<BenchRow>& rows, const std::string& provenance);
std::string bench_page(const std::vector<BenchRow>& rows, const std::string& provenance);
std::string bench_json(const std::vector<BenchRow>& rows);  // schema 1

// Announced and taken seconds of drawn designs: the table of its quantiles, and every design.
std::string prices_text(const std::vector<PriceRow>& rows);
std::string prices_csv(const std::vector<PriceRow>& rows, const std::string& provenance);

}  // namespace papilla::report
