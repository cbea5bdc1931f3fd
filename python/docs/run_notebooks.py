"""Runs the notebooks of python/examples and writes them with their outputs: PYTHONPATH=BUILD/python python/docs/run_notebooks.py"""

from __future__ import annotations

import os
import pathlib
import tempfile
from typing import Any

EXAMPLES = pathlib.Path(__file__).resolve().parent.parent / "examples"


def lasting(output: Any) -> bool:
    """Whether an output stays in the file: lines of progress are of the run alone."""
    return output.get("name") != "stderr" and not (output.output_type == "display_data" and list(output.data) == ["text/plain"])


def run(path: pathlib.Path, folder: pathlib.Path) -> Any:
    """The notebook after a run in a folder, without what differs from run to run."""
    import nbclient
    import nbformat

    os.environ.setdefault("MPLBACKEND", "module://matplotlib_inline.backend_inline")
    notebook = nbformat.read(path, as_version=4)
    nbclient.NotebookClient(notebook, timeout=600, resources={"metadata": {"path": str(folder)}}).execute()
    for cell in notebook.cells:
        cell.metadata.pop("execution", None)  # times
        if cell.cell_type == "code":
            cell.outputs = [output for output in cell.outputs if lasting(output)]
    notebook.metadata.language_info = {"name": "python"}
    return notebook


if __name__ == "__main__":
    import nbformat

    for path in sorted(EXAMPLES.glob("*.ipynb")):
        with tempfile.TemporaryDirectory() as folder:
            path.write_text(nbformat.writes(run(path, pathlib.Path(folder))) + "\n", encoding="utf-8")
        print(path.name, path.stat().st_size // 1024, "kB")
