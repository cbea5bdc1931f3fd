"""What can go wrong: mistakes of an input, and work that was stopped."""

from __future__ import annotations

from typing import NamedTuple

__all__ = ["InputError", "Problem", "Stopped"]


class Problem(NamedTuple):
    """One mistake of an input, with its place and the way out."""

    file: str
    """The file; empty where the value came from Python."""
    line: int
    """Of the file, from 1; 0 where it is not known."""
    column: int
    """Of the line, from 1; 0 where it is not known."""
    key: str
    """The key or the argument: "texture.diameter"; empty for a file as a whole."""
    message: str
    """What is wrong, what was expected, how to fix it."""

    @property
    def text(self) -> str:
        """file:line:column: key: message, as far as they are known."""
        place = ":".join(str(part) for part in (self.file, self.line, self.column) if part)
        return ": ".join(part for part in (place, self.key, self.message) if part)


class InputError(ValueError):
    """A wrong input: every mistake of it at once.

    ``problems`` holds them; the text has one line for each.
    """

    problems: tuple[Problem, ...]

    def __init__(self, problems: list[Problem]) -> None:
        self.problems = tuple(_placed(problem) for problem in problems)
        super().__init__("\n".join(problem.text for problem in self.problems))

    def __reduce__(self) -> tuple[type[InputError], tuple[list[Problem]]]:
        return InputError, (list(self.problems),)


class Stopped(RuntimeError):
    """Work that ended on someone's wish before it was done."""


# What stands for the file of a text; without a line it says nothing.
_UNNAMED = ("design.toml", "case.toml")


def wrong(key: str, message: str) -> InputError:
    """The error of one argument."""
    return InputError([Problem("", 0, 0, key, message)])


def _placed(problem: Problem) -> Problem:
    """Values from Python reach the library as ``--set KEY=VALUE``: their place is the key."""
    if problem.file in _UNNAMED and not problem.line:
        return Problem("", *problem[1:])
    if not problem.file.startswith("--set "):
        return Problem(*problem)
    key = problem.file[len("--set "):].split("=", 1)[0].rstrip(":")
    inner = problem.key
    return Problem("", 0, 0, inner if inner.startswith(key) else _longer(key, inner), problem.message)


def _longer(key: str, inner: str) -> str:
    """Of two paths the one that says more."""
    return key if key.startswith(inner) or not inner else inner
