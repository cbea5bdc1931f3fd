"""How far long work is: a function of the caller's, or a line in a notebook."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from typing import Any, Optional

Progress = Optional[Callable[..., Any]]


def shown(progress: Progress, what: str) -> Progress:
    """The caller's function; without one, in a notebook, a line that counts; else nothing."""
    if progress is not None:
        if not callable(progress):
            from papilla.errors import wrong

            raise wrong("progress", f"expected a function, got {type(progress).__name__}")
        return progress
    return _NotebookLine(what) if _in_notebook() else None


def _in_notebook() -> bool:
    shell = sys.modules.get("IPython")
    if shell is None:
        return False
    running = shell.get_ipython()
    return running is not None and hasattr(running, "kernel")


class _NotebookLine:
    """Replaces itself four times a second at most."""

    def __init__(self, what: str) -> None:
        self._what = what
        self._begin = self._shown = time.monotonic()
        self._handle: Any = None

    def __call__(self, *state: object) -> None:
        now = time.monotonic()
        if now - self._shown < 0.25:
            return
        self._shown = now
        from IPython.display import display

        line = {"text/plain": f"{self._what}: {_words(state)}, {now - self._begin:.0f} s"}
        if self._handle is None:
            self._handle = display(line, raw=True, display_id=True)
        else:
            self._handle.update(line, raw=True)


def _words(state: tuple[object, ...]) -> str:
    if len(state) == 4:
        stage, done, total, _ = state
        return f"{stage} {done} of {total}"
    if len(state) == 2:
        return f"{state[0]} of {state[1]}"
    return f"{state[0]} skin patches" if isinstance(state[0], int) else str(state[0])
