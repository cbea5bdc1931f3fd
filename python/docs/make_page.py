"""Writes the page of the Python API from its docstrings: python3 python/docs/make_page.py > docs/reference/python.md

The module has to be found (PYTHONPATH=build/ci/python). A test holds the page against this.
"""

from __future__ import annotations

import dataclasses
import inspect
import re
import textwrap
from collections.abc import Iterator

import papilla as pp
from papilla import design, errors, lab, physics, quantity, response, scans, study, sweeps, trades

SECTIONS = [("Designs", design), ("What an evaluation answers", response), ("Numbers with errors", quantity),
            ("Many evaluations", sweeps), ("Single pieces of the physics", physics), ("Measured maps", scans),
            ("Studies", study), ("Ranking, fitting, files", trades),
            ("The lab", lab), ("Errors", errors)]
HEAD = """# Python: every class and function

Made from the docstrings of `python/papilla` by `python3 python/docs/make_page.py`; `help(pp.Design)` says the same. Guide:
`docs/how_to/python.md`. Numbers are SI; a text carries its unit. `Quantified` is either.
"""


def prose(text: str) -> str:
    """Docstrings as Markdown: names in single quotes of code, examples as blocks."""
    return re.sub(r"::$", ":", text.replace("``", "`"), flags=re.M)


def signature(name: str, function: object) -> str:
    shown = str(inspect.signature(function)) if callable(function) else ""
    shown = re.sub(r"(: |-> )'([^']*)'", r"\1\2", shown)  # annotations are texts
    shown = re.sub(r"\((self|cls)(, )?", "(", shown)
    return textwrap.fill(name + shown, 120, subsequent_indent="    ", break_long_words=False)


def block(name: str, function: object) -> Iterator[str]:
    yield f"```python\n{signature(name, function)}\n```\n"
    yield prose(inspect.getdoc(function) or "") + "\n"


def attribute_docs(cls: type) -> dict[str, str]:
    """The text below each annotated member."""
    lines = inspect.getsource(cls)
    found = re.findall(r'^    (\w+): [^\n]+\n    """(.*?)"""', lines, re.M | re.S)
    found += re.findall(r'^ +self\.(\w+): [^\n]+\n +"""(.*?)"""', lines, re.M | re.S)
    return {name: " ".join(text.split()) for name, text in found}


def members(cls: type) -> Iterator[str]:
    docs = attribute_docs(cls)
    names = [f.name for f in dataclasses.fields(cls)] if dataclasses.is_dataclass(cls) else []
    names = names or [n for n in getattr(cls, "__annotations__", {}) if not n.startswith("_")]
    names += [n for n in docs if n not in names]
    rows = [f"- `{name}`{': ' + docs[name] if name in docs else ''}" for name in names]
    for name, member in vars(cls).items():
        if isinstance(member, property) and not name.startswith("_"):
            rows.append(f"- `{name}`: {' '.join((inspect.getdoc(member.fget) or '').split())}")
    if rows:
        yield prose("\n".join(rows)) + "\n"
    for name, member in vars(cls).items():
        function = member.__func__ if isinstance(member, classmethod) else member
        if inspect.isfunction(function) and not name.startswith("_"):
            yield from block(f"{cls.__name__}.{name}", function)


def page() -> str:
    out = [HEAD]
    for title, module in SECTIONS:
        out.append(f"## {title}\n")
        for name in module.__all__:
            if name not in pp.__all__:
                continue
            value = getattr(pp, name)
            out.append(f"### {name}\n")
            if inspect.isclass(value):
                out.append(prose(inspect.getdoc(value) or "") + "\n")
                out.extend(members(value))
            else:
                out.extend(block(name, value))
    return "\n".join(out)


if __name__ == "__main__":
    print(page(), end="")
