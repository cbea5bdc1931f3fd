"""Plants many mutants in one source text, each behind a switch that is read at run time."""

HEADER = """// Written by scripts/mutate: the switch of the mutants that are planted in this copy.
#pragma once
#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>

// A mistake may well deserve a warning.
#pragma GCC diagnostic ignored "-Wunused-value"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wfloat-conversion"
#pragma GCC diagnostic ignored "-Wparentheses"
#pragma GCC diagnostic ignored "-Wbool-compare"
#pragma GCC diagnostic ignored "-Wbool-operation"
#pragma GCC diagnostic ignored "-Wint-in-bool-context"
#pragma GCC diagnostic ignored "-Wdiv-by-zero"
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#pragma GCC diagnostic ignored "-Warray-bounds"
#pragma GCC diagnostic ignored "-Wtype-limits"
#pragma GCC diagnostic ignored "-Wsign-compare"
#pragma GCC diagnostic ignored "-Wtautological-compare"
#pragma GCC diagnostic ignored "-Wstringop-overflow"
#pragma GCC diagnostic ignored "-Wunused-but-set-variable"
#pragma GCC diagnostic ignored "-Wunused-variable"

namespace papilla_mutation {

// Shared with the program that asked which mutants a test reaches: written even by a process that is killed.
inline unsigned char* map_reached() {
  const char* path = std::getenv("PAPILLA_MUTANTS_REACHED");
  const int file = path ? ::open(path, O_RDWR) : -1;
  if (file < 0) return nullptr;
  void* bytes = ::mmap(nullptr, 65536, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  ::close(file);
  return bytes == MAP_FAILED ? nullptr : static_cast<unsigned char*>(bytes);
}

inline const int chosen = std::getenv("PAPILLA_MUTANT") ? std::atoi(std::getenv("PAPILLA_MUTANT")) : 0;
inline unsigned char* const reached = map_reached();

}  // namespace papilla_mutation

inline bool papilla_mutant(int id) {
  if (__builtin_expect(papilla_mutation::reached != nullptr, 0)) papilla_mutation::reached[id] = 1;
  return __builtin_expect(papilla_mutation::chosen == id, 0);
}
"""
REACHED_BYTES = 65536
INCLUDE = b'#include "papilla_mutant.h"\n'


def plant(text, edits):
    """`edits`: of one file, each with its mutant's `id`. Returns the text with all of them behind switches."""
    ordered = sorted(edits, key=lambda e: (e["start"], -e["end"], e["id"]))
    return INCLUDE + _render(text, 0, len(text), ordered)


def _render(text, start, end, edits):
    out, at = [], start
    rest = [e for e in edits if start <= e["start"] and e["end"] <= end]
    while rest:
        edit, rest = rest[0], rest[1:]
        if edit["start"] < at:
            continue  # overlaps without being inside: never from one syntax tree
        inner = [e for e in rest if e["end"] <= edit["end"]]
        rest = [e for e in rest if e["start"] >= edit["end"]]
        mutated = b"".join(p.encode() if isinstance(p, str) else _render(text, p[0], p[1], inner)
                           for p in edit["pieces"])
        original = _render(text, edit["start"], edit["end"], inner)
        out += [text[at:edit["start"]],
                b"(papilla_mutant(%d) ? (%s) : (%s))" % (edit["id"], mutated, original)]
        at = edit["end"]
    return b"".join(out) + text[at:end]
