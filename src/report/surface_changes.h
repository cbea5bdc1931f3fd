// How two surfaces of a run differ, in words whose numbers say what is behind them.
#pragma once

#include <string>

#include "base/rooms.h"
#include "search/run.h"

namespace papilla::report {

// Whose numbers are compared, for the receipts.
struct Pair {
  std::string design, other;
};

// Objectives that differ by more than the error of the difference: "raises mean(modulation) by
// 0.031 ± 0.012 (better)"; what is better comes first. "" where none does.
std::string score_changes(const ResultFiles& files, const Pair& words, const Score& design,
                          const Score& other);

// The value of a variable. of: whose it is, for the receipts.
std::string chosen_value(const Variable& variable, double value, const std::string& of);

}  // namespace papilla::report
