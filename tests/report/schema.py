"""Judges design and study files by the JSON Schema: schema.py SCHEMA.json DESIGNS_FOLDER SEED COUNT.

Every file of the folder has to pass. Then seeded mutants of them have to be refused: an unknown key or section, a
value of another kind, a unit that is missing or of another dimension, a word that is no choice.
"""
import copy
import json
import pathlib
import random
import sys
import tomllib

import jsonschema


def files(folder):
    for path in sorted(pathlib.Path(folder).rglob("*.toml")):
        tree = tomllib.loads(path.read_text())
        # Fingers, cases of `solve` and calibrations are other kinds of files.
        if "fingers" in path.parts or not ({"texture", "base", "design_space"} & set(tree)):
            continue
        yield path, tree


def places(tree, at=()):
    """Every value of a design with its path; the sections that only a study has have free keys."""
    for key, value in tree.items():
        if isinstance(value, dict):
            yield from places(value, at + (key,))
        elif not (at and at[0] in ("design_space", "scenarios", "scatter", "constraints", "objective")):
            yield at + (key,), value


def put(tree, path, value):
    out = copy.deepcopy(tree)
    node = out
    for key in path[:-1]:
        node = node[key]
    node[path[-1]] = value
    return out


def mutant(tree, chance):
    """One change that no reader takes; None where this draw has none."""
    kind = chance.choice(["key", "section", "kind", "unit", "dimension", "word"])
    if kind == "section":
        return put(tree, ("textures",), {"type": "flat"}), "section textures"
    where = list(places(tree))
    path, value = chance.choice(where)
    if kind == "key":
        node = tree
        for key in path[:-1]:
            node = node[key]
        return put(tree, path[:-1] + (path[-1] + "x",), value), f"key {path[-1]}x"
    if path[-1] in ("title", "name", "base", "file", "fingers", "risk"):
        return None
    text = isinstance(value, str)
    quantity = text and value[:1].isdigit() and " " in value
    if kind == "kind":
        return put(tree, path, {"a": 1}), f"{path} a section"
    if kind == "unit" and quantity:
        return put(tree, path, value.split()[0]), f"{path} {value.split()[0]}"
    if kind == "dimension" and quantity and len(value.split()) == 2 and "/" not in value:
        unit = "V" if value.split()[1] != "V" and not value.endswith("V") else "um"
        return put(tree, path, value.split()[0] + " " + unit), f"{path} in {unit}"
    if kind == "word" and text and not quantity:
        return put(tree, path, value + "ish"), f"{path} {value}ish"
    return None


def main():
    schema, folder, seed, count = sys.argv[1], sys.argv[2], int(sys.argv[3]), int(sys.argv[4])
    with open(schema) as stream:
        judge = jsonschema.Draft202012Validator(json.load(stream))
    trees = list(files(folder))
    wrong = [f"refused {path}: {error.json_path} {error.message[:200]}" for path, tree in trees for error in judge.iter_errors(tree)]
    chance, made = random.Random(seed), 0
    while made < count:
        path, tree = chance.choice(trees)
        change = mutant(tree, chance)
        if change is None or change[0] == tree:
            continue
        made += 1
        if judge.is_valid(change[0]):
            wrong.append(f"accepted {path} with {change[1]}")
    print(f"{len(trees)} files, {made} mutants, {len(wrong)} mistakes")
    sys.exit("\n".join(wrong[:40]) if wrong else 0)


main()
